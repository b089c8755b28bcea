-- ============================================================================
-- sphere_half - from the sphere tree to the triangles that a pencil may hit
-- ----------------------------------------------------------------------------
--   @0   address of a sphere or a vertex         tree_walk
--   @2   its word                                Sphere, Vertex memory
--   @10  tests of all planes                     fixed_testers
--        sphere: its child range to the stack if a row and a column are met
--   @11  triangle, its rows and columns          triangle_lines
--   @15  and its vertices on the pencil's grid   vertex_grid
-- model: cmodel/include/raplas/raplas_unit.hpp     tests: tb/integration/raplas_unit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity sphere_half is
  generic (
    SPHERE_ADDRESS_BITS : positive range 1 to ID_BITS := 12;
    VERTEX_ADDRESS_BITS : positive range 1 to ID_BITS := 13
  );
  port (
    clk_i          : in  std_ulogic;
    rst_i          : in  std_ulogic;
    -- host: memories
    write_node_i   : in  std_ulogic;
    write_vertex_i : in  std_ulogic;
    write_plane_i  : in  std_ulogic;
    address_i      : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    data_i         : in  std_ulogic_vector(2 * FIXED_PLANE_BITS - 1 downto 0);
                      -- the widest of the three: two planes
    -- the pencil whose turn it is
    bank_i         : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    rows_i         : in  std_ulogic_vector(LINE_BITS downto 0);
    columns_i      : in  std_ulogic_vector(LINE_BITS downto 0);
    slack_i        : in  std_ulogic_vector(COORDINATE_BITS - 1 downto 0);
    scale_i        : in  std_ulogic_vector(GRID_EXPONENT_BITS - 1 downto 0);
    least_i        : in  std_ulogic_vector(GRID_EXPONENT_BITS - 1 downto 0);
    load_i         : in  std_ulogic;                                  -- planes of line_i, please
    load_bank_i    : in  std_ulogic_vector(BANK_BITS - 1 downto 0);   -- of this bank
    line_i         : in  std_ulogic_vector(PLANE_INDEX_BITS - 1 downto 0);
    walk_i         : in  std_ulogic;                                  -- the walk begins
    spent_o        : out std_ulogic;                                  -- no object goes any more
    idle_o         : out std_ulogic;                                  -- it is over
    root_first_i   : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    root_count_i   : in  std_ulogic_vector(COUNT_BITS - 1 downto 0);
    row_bounds_i   : in  std_ulogic_vector(MAX_ROWS * DEPTH_BITS - 1 downto 0);
    token_i        : in  std_ulogic;                                  -- the pencil's end, please
    token_ready_o  : out std_ulogic;                                  -- it is taken in this clock
    -- triangles, and the end of the pencil behind them
    triangles_i    : in  std_ulogic_vector(TRIANGLE_FIFO_DEPTH_LOG2 downto 0);   -- in the queue
    valid_o        : out std_ulogic;
    word_o         : out queued_triangle_word_t;
    -- for counters and traces
    request_o      : out std_ulogic;
    vertex_o       : out std_ulogic;                                  -- the request is a vertex'
    object_o       : out std_ulogic_vector(ID_BITS - 1 downto 0);     -- its address
    stack_level_o  : out std_ulogic_vector(STACK_DEPTH_LOG2 downto 0);
    push_o         : out std_ulogic
  );
end entity sphere_half;

architecture rtl of sphere_half is

  constant TEST_STAGES   : positive := PLANE_TEST_STAGES + DEPTH_CODE_STAGES;
  constant MASK_BITS     : positive := MAX_ROWS + MAX_COLUMNS;
  constant RANGE_BITS    : positive := 1 + COUNT_BITS + ID_BITS + MASK_BITS + DEPTH_BITS;
  constant CHILDREN_BITS : positive := 1 + COUNT_BITS + ID_BITS;               -- leaf count first
  constant STEP_BITS     : positive := 2 + MASK_BITS;                          -- vertex last masks
  constant TAG_BITS      : positive := STEP_BITS + CHILDREN_BITS;
  constant PLACE_BITS    : positive := 3 + ID_BITS;                            -- slot emit triangle
  constant POINT_BITS    : positive := 3 * COORDINATE_BITS;
  constant PLANE_ADDRESS_BITS : positive := BANK_BITS + PLANE_INDEX_BITS;
  constant GRID_STAGES   : positive := VERTEX_GRID_STAGES - 1;   -- from a triangle to its points
  constant RESERVE       : positive := GRID_STAGES + 2;   -- triangles between the walk's count
                                                          -- and the queue's
  constant FOUND_BITS    : positive := QUEUED_TRIANGLE_BITS - 3 * GRID_POINT_BITS;

  subtype mask_t is std_ulogic_vector(MAX_ROWS - 1 downto 0);

  -- @0
  signal request, vertex, last : std_ulogic;
  signal address         : std_ulogic_vector(ID_BITS - 1 downto 0);
  signal rows, columns   : mask_t;
  signal start_rows, start_columns : mask_t;
  signal waiting         : std_ulogic_vector(TRIANGLE_FIFO_DEPTH_LOG2 downto 0);
  signal request_s0, request_s2, request_s10 : std_ulogic_vector(0 downto 0);
  signal step_s0, step_s2 : std_ulogic_vector(STEP_BITS - 1 downto 0);
  -- @2
  signal node_word       : node_word_t;
  signal vertex_word     : vertex_word_t;
  signal children        : std_ulogic_vector(CHILDREN_BITS - 1 downto 0);
  signal object          : std_ulogic_vector(POINT_BITS + COORDINATE_BITS - 1 downto 0);
  signal tag_s2, tag_s10 : std_ulogic_vector(TAG_BITS - 1 downto 0);
  -- planes
  signal plane_address   : std_ulogic_vector(PLANE_ADDRESS_BITS - 1 downto 0);
  signal planes          : std_ulogic_vector(2 * FIXED_PLANE_BITS - 1 downto 0);   -- column row
  signal load_s0, load_s2 : std_ulogic_vector(PLANE_INDEX_BITS downto 0);
  -- @10
  signal rows_meet, rows_above, columns_meet, columns_above : mask_t;
  signal near            : std_ulogic;
  signal z               : std_ulogic_vector(DEPTH_BITS - 1 downto 0);
  signal depth_sum_code  : std_ulogic_vector(DEPTH_BITS - 1 downto 0);
  signal down_sum, across_sum : std_ulogic_vector(PLANE_SUM_BITS - 1 downto 0);
  signal rows_s10, columns_s10 : mask_t;
  signal met_rows, met_columns : mask_t;
  signal vertex_s10, last_s10, push, place_valid : std_ulogic;
  signal place           : std_ulogic_vector(PLACE_BITS - 1 downto 0);
  signal push_range      : std_ulogic_vector(RANGE_BITS - 1 downto 0);

  -- @11
  signal line_valid, token_ready : std_ulogic;
  signal line_rows, line_columns : mask_t;
  signal line_z          : depth_t;
  signal line_triangle   : std_ulogic_vector(ID_BITS - 1 downto 0);
  signal token           : std_ulogic_vector(0 downto 0);
  signal valid_s11, valid_s15 : std_ulogic_vector(0 downto 0);
  signal found_s11, found_s15 : std_ulogic_vector(FOUND_BITS - 1 downto 0);
  -- @15
  signal points          : std_ulogic_vector(3 * GRID_POINT_BITS - 1 downto 0);

  function lines(count : std_ulogic_vector(LINE_BITS downto 0)) return mask_t is
    variable mask_v : mask_t := (others => '0');
  begin
    for k in mask_v'range loop
      if unsigned(count) > k then
        mask_v(k) := '1';
      end if;
    end loop;
    return mask_v;
  end function lines;

begin

  -- @0
  start_rows    <= lines(rows_i);
  start_columns <= lines(columns_i);
  waiting       <= std_ulogic_vector(unsigned(triangles_i) + RESERVE);

  walk_e : entity raplas.tree_walk
    port map (
      clk_i          => clk_i,
      rst_i          => rst_i,
      start_i        => walk_i,
      root_first_i   => root_first_i,
      root_count_i   => root_count_i,
      rows_i         => start_rows,
      columns_i      => start_columns,
      row_bounds_i   => row_bounds_i,
      push_i         => push,
      push_range_i   => push_range,
      decided_i      => request_s10(0),
      last_sibling_i => last_s10,
      triangles_i    => waiting,
      request_o      => request,
      vertex_o       => vertex,
      address_o      => address,
      rows_o         => rows,
      columns_o      => columns,
      last_o         => last,
      stack_level_o  => stack_level_o,
      spent_o        => spent_o,
      idle_o         => idle_o
    );

  request_s0(0) <= request;
  step_s0       <= vertex & last & rows & columns;

  request_delay_2 : entity raplas.delay
    generic map (WIDTH => 1, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => request_s0, data_o => request_s2);

  step_delay : entity raplas.delay
    generic map (WIDTH => STEP_BITS, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => step_s0, data_o => step_s2);

  node_memory_i : entity raplas.ram
    generic map (WIDTH => NODE_BITS, ADDRESS_BITS => SPHERE_ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write_node_i,
      write_address_i => address_i(SPHERE_ADDRESS_BITS - 1 downto 0),
      write_data_i    => data_i(NODE_BITS - 1 downto 0),
      read_address_i  => address(SPHERE_ADDRESS_BITS - 1 downto 0),
      read_data_o     => node_word
    );

  vertex_memory_i : entity raplas.ram
    generic map (WIDTH => VERTEX_BITS, ADDRESS_BITS => VERTEX_ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write_vertex_i,
      write_address_i => address_i(VERTEX_ADDRESS_BITS - 1 downto 0),
      write_data_i    => data_i(VERTEX_BITS - 1 downto 0),
      read_address_i  => address(VERTEX_ADDRESS_BITS - 1 downto 0),
      read_data_o     => vertex_word
    );

  -- @2: a vertex is a sphere of radius 0; the place of its children is that of slot, emit, triangle
  object_p : process (step_s2, node_word, vertex_word)
    constant NO_RADIUS : std_ulogic_vector(COORDINATE_BITS - 1 downto 0) := (others => '0');
  begin
    if step_s2(STEP_BITS - 1) = '1' then
      object   <= vertex_word(VERTEX_BITS - 1 downto PLACE_BITS) & NO_RADIUS;
      children <= std_ulogic_vector(resize(unsigned(vertex_word(PLACE_BITS - 1 downto 0)),
                                           CHILDREN_BITS));
    else
      object   <= node_word(NODE_BITS - 1 downto CHILDREN_BITS);
      children <= node_word(CHILDREN_BITS - 1 downto 0);
    end if;
  end process object_p;

  tag_s2 <= step_s2 & children;

  request_delay_10 : entity raplas.delay
    generic map (WIDTH => 1, STAGES => TEST_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => request_s2, data_o => request_s10);

  tag_delay : entity raplas.delay
    generic map (WIDTH => TAG_BITS, STAGES => TEST_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => tag_s2, data_o => tag_s10);

  -- planes: from their memory, one for each side, into the testers' own registers
  plane_address <= load_bank_i & line_i;
  load_s0       <= load_i & line_i;

  plane_memory_i : entity raplas.ram
    generic map (WIDTH => 2 * FIXED_PLANE_BITS, ADDRESS_BITS => PLANE_ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write_plane_i,
      write_address_i => address_i(PLANE_ADDRESS_BITS - 1 downto 0),
      write_data_i    => data_i,
      read_address_i  => plane_address,
      read_data_o     => planes
    );

  load_delay : entity raplas.delay
    generic map (WIDTH => PLANE_INDEX_BITS + 1, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => load_s0, data_o => load_s2);

  testers_i : entity raplas.fixed_testers
    port map (
      clk_i            => clk_i,
      load_i           => load_s2(PLANE_INDEX_BITS),
      row_plane_i      => planes(FIXED_PLANE_BITS - 1 downto 0),
      column_plane_i   => planes(2 * FIXED_PLANE_BITS - 1 downto FIXED_PLANE_BITS),
      index_i          => load_s2(PLANE_INDEX_BITS - 1 downto 0),
      object_i         => object,
      slack_i          => slack_i,
      rows_meet_o      => rows_meet,
      rows_above_o     => rows_above,
      columns_meet_o   => columns_meet,
      columns_above_o  => columns_above,
      near_o           => near,
      z_o              => z,
      depth_sum_code_o => depth_sum_code,
      down_sum_o       => down_sum,
      across_sum_o     => across_sum
    );

  -- @10
  vertex_s10  <= tag_s10(TAG_BITS - 1);
  last_s10    <= tag_s10(TAG_BITS - 2);
  rows_s10    <= tag_s10(CHILDREN_BITS + MASK_BITS - 1 downto CHILDREN_BITS + MAX_COLUMNS);
  columns_s10 <= tag_s10(CHILDREN_BITS + MAX_COLUMNS - 1 downto CHILDREN_BITS);
  met_rows    <= rows_s10 and rows_meet;
  met_columns <= columns_s10 and columns_meet;
  push        <= '1' when request_s10(0) = '1' and vertex_s10 = '0' and near = '1'
                          and unsigned(met_rows) /= 0 and unsigned(met_columns) /= 0 else '0';
  push_range  <= tag_s10(CHILDREN_BITS - 1 downto 0) & met_rows & met_columns & z;
  place_valid <= request_s10(0) and vertex_s10;
  place       <= tag_s10(PLACE_BITS - 1 downto 0);

  lines_i : entity raplas.triangle_lines
    port map (
      clk_i           => clk_i,
      rst_i           => rst_i,
      valid_i         => place_valid,
      slot_i          => place(PLACE_BITS - 1 downto PLACE_BITS - 2),
      emit_i          => place(PLACE_BITS - 3),
      rows_meet_i     => rows_meet,
      rows_above_i    => rows_above,
      columns_meet_i  => columns_meet,
      columns_above_i => columns_above,
      near_i          => near,
      z_i             => z,
      rows_i          => rows_s10,
      columns_i       => columns_s10,
      triangle_i      => place(ID_BITS - 1 downto 0),
      valid_o         => line_valid,
      rows_o          => line_rows,
      columns_o       => line_columns,
      z_o             => line_z,
      triangle_o      => line_triangle
    );

  grid_i : entity raplas.vertex_grid
    port map (
      clk_i    => clk_i,
      valid_i  => place_valid,
      slot_i   => place(PLACE_BITS - 1 downto PLACE_BITS - 2),
      across_i => across_sum,
      down_i   => down_sum,
      depth_i  => depth_sum_code,
      scale_i  => scale_i,
      least_i  => least_i,
      points_o => points
    );

  -- @11: a triangle, or the end of the pencil: the walk is over, and none comes in that clock
  token_ready   <= not waiting(TRIANGLE_FIFO_DEPTH_LOG2);
  token_ready_o <= token_ready;
  token(0)      <= token_i and token_ready;
  valid_s11(0)  <= line_valid or token(0);
  found_s11     <= token & bank_i & line_triangle & line_z & line_rows & line_columns;

  valid_delay_15 : entity raplas.delay
    generic map (WIDTH => 1, STAGES => GRID_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => valid_s11, data_o => valid_s15);

  found_delay_15 : entity raplas.delay
    generic map (WIDTH => FOUND_BITS, STAGES => GRID_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => found_s11, data_o => found_s15);

  valid_o   <= valid_s15(0);
  word_o    <= found_s15 & points;
  request_o <= request;
  vertex_o  <= vertex;
  object_o  <= address;
  push_o    <= push;

end architecture rtl;
