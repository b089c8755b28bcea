-- ============================================================================
-- raplas_unit - the whole accelerator of profile raplas
-- ----------------------------------------------------------------------------
--   pencil_control: one pencil after the other
--   sphere_half:    sphere tree -> triangles that the pencil may hit
--   pair_half:      triangles -> (ray, triangle) pairs -> nearest hits
-- The host writes words with target, address and data (right-aligned), and starts
-- loaded banks, up to PENCIL_BANKS of them; a bank's results stand from when its busy
-- bit is 0 again until it is started again. The counters count from reset on.
-- The ports in the last group show the edges between the units for traces; left
-- open they cost nothing.
-- model: cmodel/include/raplas/raplas_unit.hpp     tests: tb/integration/raplas_unit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity raplas_unit is
  generic (
    GUARD_BITS            : natural range 0 to 2 := 2;
    SPHERE_ADDRESS_BITS   : positive range 1 to ID_BITS := 12;   -- 2**12 spheres
    VERTEX_ADDRESS_BITS   : positive range 1 to ID_BITS := 13;   -- 2**13 vertices
    TRIANGLE_ADDRESS_BITS : positive range 1 to ID_BITS := 12    -- 2**12 triangles
  );
  port (
    clk_i           : in  std_ulogic;
    rst_i           : in  std_ulogic;
    -- host: memories and registers
    write_i         : in  std_ulogic;
    target_i        : in  std_ulogic_vector(2 downto 0);                 -- TARGET_*
    address_i       : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    data_i          : in  std_ulogic_vector(TRIANGLE_BITS - 1 downto 0);
    result_ray_i    : in  std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - 1 downto 0);   -- bank, ray
    result_o        : out ray_hits_word_t;                               -- MEMORY_STAGES later
    hit_rows_o      : out std_ulogic_vector(PENCIL_BANKS * MAX_ROWS - 1 downto 0);
                      -- bank b, row r at b * MAX_ROWS + r: a ray of it has a hit
    -- host: control
    start_i         : in  std_ulogic;
    bank_i          : in  std_ulogic_vector(BANK_BITS - 1 downto 0);     -- of the pencil to start
    busy_o          : out std_ulogic_vector(PENCIL_BANKS - 1 downto 0);
    counters_o      : out std_ulogic_vector(NUM_COUNTERS * COUNTER_BITS - 1 downto 0);
                      -- COUNTER_* from the low end
    -- edges between the units
    request_o       : out std_ulogic;                                    -- to the testers
    vertex_o        : out std_ulogic;
    object_o        : out std_ulogic_vector(ID_BITS - 1 downto 0);
    stack_level_o   : out std_ulogic_vector(STACK_DEPTH_LOG2 downto 0);
    push_o          : out std_ulogic;
    triangle_found_o : out std_ulogic;                                   -- to the triangle queue
    found_triangle_o : out std_ulogic_vector(ID_BITS - 1 downto 0);
    found_rows_o     : out std_ulogic_vector(MAX_ROWS - 1 downto 0);
    found_columns_o  : out std_ulogic_vector(MAX_COLUMNS - 1 downto 0);
    found_points_o   : out std_ulogic_vector(3 * GRID_POINT_BITS - 1 downto 0);
    found_z_o        : out std_ulogic_vector(DEPTH_BITS - 1 downto 0);
    issue_o         : out std_ulogic;                                    -- pair to ray_solver
    ray_o           : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    triangle_o      : out std_ulogic_vector(ID_BITS - 1 downto 0);
    stall_o         : out std_ulogic;
    hit_o           : out std_ulogic;                                    -- ray_solver @26
    stored_o        : out std_ulogic;
    stored_ray_o    : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    stored_result_o : out ray_hits_word_t
  );
end entity raplas_unit;

architecture rtl of raplas_unit is

  -- registers that the host writes
  type pencils_t is array (0 to PENCIL_BANKS - 1) of pencil_word_t;
  type limits_words_t is array (0 to PENCIL_BANKS - 1) of limits_word_t;
  signal pencils      : pencils_t;
  signal limits_words : limits_words_t;
  signal scene_word   : scene_word_t;
  signal scene        : scene_t;
  signal write        : std_ulogic_vector(7 downto 0);   -- one for each target
  signal all_pencils  : std_ulogic_vector(PENCIL_BANKS * PENCIL_BITS - 1 downto 0);
  signal all_limits   : std_ulogic_vector(PENCIL_BANKS * LIMITS_BITS - 1 downto 0);

  -- the pencil that is cleared, that whose planes are loaded, that whose turn it is
  signal clear_bank, load_bank, bank       : bank_t;
  signal clear_pencil, pencil              : pencil_t;
  signal clear_limits, limits              : limits_t;
  signal clear, load                       : std_ulogic;
  signal walk, walk_tree, spent, walk_idle : std_ulogic;
  signal line         : std_ulogic_vector(PLANE_INDEX_BITS - 1 downto 0);
  signal row_bounds   : std_ulogic_vector(MAX_ROWS * DEPTH_BITS - 1 downto 0);

  -- triangles
  signal token, token_ready : std_ulogic;
  signal found_valid    : std_ulogic;              -- a triangle, or the end of the pencil
  signal found_word     : queued_triangle_word_t;
  signal found          : queued_triangle_t;
  signal triangles      : std_ulogic_vector(TRIANGLE_FIFO_DEPTH_LOG2 downto 0);

  signal request, vertex, issue, stall, first_hit, done, busy_any : std_ulogic;
  signal done_bank      : bank_t;
  signal busy           : std_ulogic_vector(PENCIL_BANKS - 1 downto 0);

begin

  -- --------------------------------------------------------------------------
  -- registers
  -- --------------------------------------------------------------------------
  targets_g : for k in write'range generate
    write(k) <= write_i when unsigned(target_i) = k else '0';
  end generate targets_g;

  registers_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      for k in 0 to PENCIL_BANKS - 1 loop
        if write(TARGET_PENCIL) = '1' and unsigned(address_i(BANK_BITS - 1 downto 0)) = k then
          pencils(k) <= data_i(PENCIL_BITS - 1 downto 0);
        end if;
        if write(TARGET_LIMITS) = '1' and unsigned(address_i(BANK_BITS - 1 downto 0)) = k then
          limits_words(k) <= data_i(LIMITS_BITS - 1 downto 0);
        end if;
      end loop;
      if write(TARGET_SCENE) = '1' then
        scene_word <= data_i(SCENE_BITS - 1 downto 0);
      end if;
    end if;
  end process registers_p;

  scene <= unpack_scene(scene_word);

  banks_p : process (pencils, limits_words, bank, clear_bank)
  begin
    pencil       <= unpack_pencil(pencils(0));
    limits       <= unpack_limits(limits_words(0));
    clear_pencil <= unpack_pencil(pencils(0));
    clear_limits <= unpack_limits(limits_words(0));
    for k in 1 to PENCIL_BANKS - 1 loop
      if unsigned(clear_bank) = k then
        clear_pencil <= unpack_pencil(pencils(k));
        clear_limits <= unpack_limits(limits_words(k));
      end if;
      if unsigned(bank) = k then
        pencil <= unpack_pencil(pencils(k));
        limits <= unpack_limits(limits_words(k));
      end if;
    end loop;
  end process banks_p;

  registers_g : for k in 0 to PENCIL_BANKS - 1 generate
    all_pencils((k + 1) * PENCIL_BITS - 1 downto k * PENCIL_BITS) <= pencils(k);
    all_limits((k + 1) * LIMITS_BITS - 1 downto k * LIMITS_BITS) <= limits_words(k);
  end generate registers_g;

  -- --------------------------------------------------------------------------
  -- control and counters
  -- --------------------------------------------------------------------------
  control_i : entity raplas.pencil_control
    port map (
      clk_i         => clk_i,
      rst_i         => rst_i,
      start_i       => start_i,
      bank_i        => bank_i,
      busy_o        => busy,
      clear_o       => clear,
      clear_bank_o  => clear_bank,
      rows_i        => clear_pencil.rows,
      columns_i     => clear_pencil.columns,
      load_o        => load,
      load_bank_o   => load_bank,
      line_o        => line,
      bank_o        => bank,
      walk_o        => walk,
      walk_spent_i  => spent,
      walk_idle_i   => walk_idle,
      token_o       => token,
      token_ready_i => token_ready,
      done_i        => done,
      done_bank_i   => done_bank
    );

  -- an empty scene has nothing to walk through
  walk_tree <= walk when unsigned(scene.count(COUNT_BITS - 1 downto 0)) /= 0 else '0';
  busy_any  <= '1' when unsigned(busy) /= 0 else '0';

  counters_i : entity raplas.unit_counters
    port map (
      clk_i       => clk_i,
      rst_i       => rst_i,
      spheres_i   => scene.spheres,
      rows_i      => pencil.rows,
      columns_i   => pencil.columns,
      walk_i      => walk,
      busy_i      => busy_any,
      request_i   => request,
      vertex_i    => vertex,
      issue_i     => issue,
      first_hit_i => first_hit,
      stall_i     => stall,
      counters_o  => counters_o
    );

  -- --------------------------------------------------------------------------
  -- the two halves
  -- --------------------------------------------------------------------------
  spheres_i : entity raplas.sphere_half
    generic map (SPHERE_ADDRESS_BITS => SPHERE_ADDRESS_BITS,
                 VERTEX_ADDRESS_BITS => VERTEX_ADDRESS_BITS)
    port map (
      clk_i          => clk_i,
      rst_i          => rst_i,
      write_node_i   => write(TARGET_SPHERE),
      write_vertex_i => write(TARGET_VERTEX),
      write_plane_i  => write(TARGET_PLANE),
      address_i      => address_i,
      data_i         => data_i(2 * FIXED_PLANE_BITS - 1 downto 0),
      bank_i         => bank,
      rows_i         => pencil.rows,
      columns_i      => pencil.columns,
      slack_i        => limits.slack,
      scale_i        => limits.scale,
      least_i        => limits.least,
      load_i         => load,
      load_bank_i    => load_bank,
      line_i         => line,
      walk_i         => walk_tree,
      spent_o        => spent,
      idle_o         => walk_idle,
      root_first_i   => scene.first,
      root_count_i   => scene.count(COUNT_BITS - 1 downto 0),
      row_bounds_i   => row_bounds,
      token_i        => token,
      token_ready_o  => token_ready,
      triangles_i    => triangles,
      valid_o        => found_valid,
      word_o         => found_word,
      request_o      => request,
      vertex_o       => vertex,
      object_o       => object_o,
      stack_level_o  => stack_level_o,
      push_o         => push_o
    );

  pairs_i : entity raplas.pair_half
    generic map (GUARD_BITS => GUARD_BITS, TRIANGLE_ADDRESS_BITS => TRIANGLE_ADDRESS_BITS)
    port map (
      clk_i              => clk_i,
      rst_i              => rst_i,
      write_ray_i        => write(TARGET_RAY),
      write_triangle_i   => write(TARGET_TRIANGLE),
      address_i          => address_i,
      data_i             => data_i,
      result_ray_i       => result_ray_i,
      result_o           => result_o,
      hit_rows_o         => hit_rows_o,
      pencils_i          => all_pencils,
      limits_i           => all_limits,
      clear_i            => clear,
      clear_bank_i       => clear_bank,
      clear_rows_i       => clear_pencil.rows,
      clear_far_i        => clear_limits.far,
      walk_bank_i        => bank,
      row_bounds_o       => row_bounds,
      valid_i            => found_valid,
      word_i             => found_word,
      triangles_o        => triangles,
      done_o             => done,
      done_bank_o        => done_bank,
      issue_o            => issue,
      ray_o              => ray_o,
      pair_triangle_o    => triangle_o,
      stall_o            => stall,
      hit_o              => hit_o,
      first_hit_o        => first_hit,
      stored_o           => stored_o,
      stored_ray_o       => stored_ray_o,
      stored_result_o    => stored_result_o
    );

  -- --------------------------------------------------------------------------
  -- ports
  -- --------------------------------------------------------------------------
  busy_o           <= busy;
  request_o        <= request;
  vertex_o         <= vertex;
  found            <= unpack_queued_triangle(found_word);
  triangle_found_o <= found_valid and not found.last;
  found_triangle_o <= found.triangle;
  found_rows_o     <= found.rows;
  found_columns_o  <= found.columns;
  found_z_o        <= found.z;
  found_points_o   <= found_word(3 * GRID_POINT_BITS - 1 downto 0);
  issue_o          <= issue;
  stall_o          <= stall;

end architecture rtl;
