-- ============================================================================
-- intersection_unit - traces a pencil: from its planes to the nearest hits
-- ----------------------------------------------------------------------------
--   traversal -> Sphere, Plane memory -> plane_sphere_subunit -> decoder
--     -> leaf queue -> selector -> pair queue -> pair_issue
--     -> Ray, Triangle memory -> ray_triangle -> Result memory
-- One direction; only child ranges go back, from the decoder to the traversal.
-- The host writes words with target, address and data (right-aligned), gives
-- start_i with the bank of a loaded pencil while busy_o is low, and reads the
-- results when busy_o is low again. It may load the other bank meanwhile.
-- The ports in the last group show the edges between the units for traces; left
-- open they cost nothing.
-- model: cmodel/include/raplas/intersection_unit.hpp
-- tests: tb/integration/intersection_unit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity intersection_unit is
  generic (
    NUM_ROWS              : positive range 1 to MAX_ROWS := 4;     -- row testers: a power of two
    NUM_COLUMNS           : positive range 1 to MAX_COLUMNS := 4;  -- column testers: likewise
    GUARD_BITS            : natural range 0 to 2 := 2;
    SPHERE_ADDRESS_BITS   : positive range 1 to ID_BITS := 12;   -- 2**12 spheres
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
    result_ray_i    : in  std_ulogic_vector(2 * LINE_BITS downto 0);     -- bank, ray
    result_o        : out result_word_t;                                 -- MEMORY_STAGES later
    -- host: control
    start_i         : in  std_ulogic;
    bank_i          : in  std_ulogic;                                    -- of the pencil to start
    busy_o          : out std_ulogic;
    counters_o      : out std_ulogic_vector(NUM_COUNTERS * COUNTER_BITS - 1 downto 0);
                      -- of the last pencil; COUNTER_* from the low end
    -- edges between the units
    request_o       : out std_ulogic;                               -- sphere and set to the testers
    sphere_o        : out std_ulogic_vector(ID_BITS - 1 downto 0);
    set_o           : out std_ulogic_vector(LINE_BITS - 1 downto 0);
    stack_level_o   : out std_ulogic_vector(STACK_DEPTH_LOG2 downto 0);
    decided_o       : out std_ulogic;                                    -- decoder: sphere decided
    leaf_o          : out std_ulogic;
    push_o          : out std_ulogic;
    row_mask_o      : out std_ulogic_vector(MAX_ROWS - 1 downto 0);
    column_mask_o   : out std_ulogic_vector(MAX_COLUMNS - 1 downto 0);
    issue_o         : out std_ulogic;                                    -- pair to ray_triangle
    stall_o         : out std_ulogic;
    ray_o           : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    triangle_o      : out std_ulogic_vector(ID_BITS - 1 downto 0);
    pair_done_o     : out std_ulogic;                                    -- ray_triangle @29
    hit_o           : out std_ulogic;
    stored_o        : out std_ulogic;
    stored_ray_o    : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    stored_result_o : out result_word_t
  );
end entity intersection_unit;

architecture rtl of intersection_unit is

  constant TESTER_STAGES : positive := MUL_STAGES + 2 * ADD_STAGES + COMPARE_STAGES;
  constant NODE_BITS     : positive := 1 + COUNT_BITS + ID_BITS;         -- leaf count first
  constant STEP_BITS     : positive := LINE_BITS + 1;                    -- last set
  constant TAG_BITS      : positive := NODE_BITS + STEP_BITS;
  constant LEAF_BITS     : positive := ID_BITS + COUNT_BITS + MAX_ROWS + MAX_COLUMNS;
  constant PIPE_BITS     : positive := 6;   -- at most MEMORY_STAGES + 29 pairs are under way
  constant PAIR_BITS     : positive := ID_BITS + 2 * LINE_BITS;

  subtype mask_t is std_ulogic_vector(MAX_ROWS - 1 downto 0);
  subtype ray_id_t is std_ulogic_vector(2 * LINE_BITS - 1 downto 0);

  -- registers that the host writes
  type pencils_t is array (0 to 1) of pencil_word_t;
  signal pencils    : pencils_t;
  signal scene_word : scene_word_t;
  signal scene      : scene_t;
  signal write      : std_ulogic_vector(5 downto 0);   -- one for each target
  signal bank       : std_ulogic;
  signal pencil     : pencil_t;
  signal origin     : std_ulogic_vector(3 * FP_BITS - 1 downto 0);
  signal last_set   : std_ulogic_vector(LINE_BITS - 1 downto 0);

  -- control
  signal busy       : std_ulogic;
  signal starting   : std_ulogic;   -- the clock after start_i: the pencil's registers are in place
  signal in_pipe    : unsigned(PIPE_BITS - 1 downto 0);   -- pairs issued and not decided
  signal idle       : std_ulogic;

  -- traversal to decoder
  signal request, first_set, last, traversal_idle : std_ulogic;
  signal sphere_address : std_ulogic_vector(ID_BITS - 1 downto 0);
  signal set            : std_ulogic_vector(LINE_BITS - 1 downto 0);
  signal step           : std_ulogic_vector(STEP_BITS downto 0);    -- valid last set
  signal step_s2        : std_ulogic_vector(STEP_BITS downto 0);
  signal sphere_word    : sphere_word_t;
  signal planes         : std_ulogic_vector((NUM_ROWS + NUM_COLUMNS) * PLANE_BITS - 1 downto 0);
  signal tag, tag_s12   : std_ulogic_vector(TAG_BITS - 1 downto 0);
  signal tested         : std_ulogic;
  signal row_flags      : std_ulogic_vector(NUM_ROWS - 1 downto 0);
  signal column_flags   : std_ulogic_vector(NUM_COLUMNS - 1 downto 0);
  signal node_s13       : std_ulogic_vector(NODE_BITS - 2 downto 0);   -- count first
  signal decided, leaf, push : std_ulogic;
  signal row_mask, column_mask : mask_t;

  -- leaf queue to ray_triangle
  signal leaf_in, leaf_out : std_ulogic_vector(LEAF_BITS - 1 downto 0);
  signal leaf_valid        : std_ulogic;
  signal leaves            : std_ulogic_vector(LEAF_FIFO_DEPTH_LOG2 downto 0);
  signal selector_ready, selector_valid : std_ulogic;
  signal pair_in, pair_out, pair_s2     : std_ulogic_vector(PAIR_BITS - 1 downto 0);
  signal pair_valid, pair_ready         : std_ulogic;
  signal issue, stall                   : std_ulogic;
  signal issue_s0, issue_s2             : std_ulogic_vector(0 downto 0);
  signal ray_address                    : std_ulogic_vector(2 * LINE_BITS downto 0);
  signal ray_word                       : ray_word_t;
  signal triangle_word                  : triangle_word_t;

  -- results
  signal best_ray, stored_ray : ray_id_t;
  signal best, stored_result  : result_word_t;
  signal pair_done, hit, stored, first_hit : std_ulogic;
  signal result_bank : std_ulogic_vector(BANK_BITS - 1 downto 0);
  signal host_ray    : std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - 1 downto 0);

begin

  -- --------------------------------------------------------------------------
  -- registers and control
  -- --------------------------------------------------------------------------
  targets_g : for k in write'range generate
    write(k) <= write_i when unsigned(target_i) = k else '0';
  end generate targets_g;

  registers_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if write(TARGET_PENCIL) = '1' and address_i(0) = '0' then
        pencils(0) <= data_i(PENCIL_BITS - 1 downto 0);
      end if;
      if write(TARGET_PENCIL) = '1' and address_i(0) = '1' then
        pencils(1) <= data_i(PENCIL_BITS - 1 downto 0);
      end if;
      if write(TARGET_SCENE) = '1' then
        scene_word <= data_i(SCENE_BITS - 1 downto 0);
      end if;
    end if;
  end process registers_p;

  scene  <= unpack_scene(scene_word);
  pencil <= unpack_pencil(pencils(0)) when bank = '0' else unpack_pencil(pencils(1));
  origin <= pencil.ox & pencil.oy & pencil.oz;

  last_set_p : process (pencil)
    variable row_set_v    : unsigned(LINE_BITS downto 0);
    variable column_set_v : unsigned(LINE_BITS downto 0);
  begin
    row_set_v    := (unsigned(pencil.rows) - 1) / NUM_ROWS;
    column_set_v := (unsigned(pencil.columns) - 1) / NUM_COLUMNS;
    if row_set_v > column_set_v then
      last_set <= std_ulogic_vector(row_set_v(LINE_BITS - 1 downto 0));
    else
      last_set <= std_ulogic_vector(column_set_v(LINE_BITS - 1 downto 0));
    end if;
  end process last_set_p;

  idle <= '1' when traversal_idle = '1' and starting = '0' and leaf_valid = '0'
                   and selector_valid = '0' and pair_valid = '0' and in_pipe = 0 else '0';

  control_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      starting <= start_i and not busy;
      if start_i = '1' and busy = '0' then
        bank <= bank_i;
        busy <= '1';
      elsif idle = '1' then
        busy <= '0';
      end if;
      if issue = '1' and pair_done = '0' then
        in_pipe <= in_pipe + 1;
      elsif issue = '0' and pair_done = '1' then
        in_pipe <= in_pipe - 1;
      end if;
      if rst_i = '1' then
        starting <= '0';
        busy     <= '0';
        in_pipe  <= (others => '0');
      end if;
    end if;
  end process control_p;

  counters_i : entity raplas.event_counters
    port map (
      clk_i         => clk_i,
      clear_i       => starting,
      spheres_i     => scene.spheres,
      rows_i        => pencil.rows,
      columns_i     => pencil.columns,
      busy_i        => busy,
      sphere_i      => step(STEP_BITS),
      first_set_i   => first_set,
      issue_i       => issue,
      first_hit_i   => first_hit,
      stall_i       => stall,
      counters_o    => counters_o
    );

  -- --------------------------------------------------------------------------
  -- spheres: traversal, testers, decoder
  -- --------------------------------------------------------------------------
  traversal_i : entity raplas.traversal
    port map (
      clk_i         => clk_i,
      rst_i         => rst_i,
      start_i       => starting,
      root_first_i  => scene.first,
      root_count_i  => scene.count,
      last_set_i    => last_set,
      push_i        => push,
      push_first_i  => node_s13(ID_BITS - 1 downto 0),
      push_count_i  => node_s13(ID_BITS + COUNT_BITS - 1 downto ID_BITS),
      decided_i     => decided,
      leaves_i      => leaves,
      request_o     => request,
      first_o       => first_set,
      last_o        => last,
      address_o     => sphere_address,
      set_o         => set,
      stack_level_o => stack_level_o,
      idle_o        => traversal_idle
    );

  step <= request & last & set;

  step_delay : entity raplas.delay
    generic map (WIDTH => STEP_BITS + 1, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => step, data_o => step_s2);

  sphere_memory_i : entity raplas.ram
    generic map (WIDTH => SPHERE_BITS, ADDRESS_BITS => SPHERE_ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write(TARGET_SPHERE),
      write_address_i => address_i(SPHERE_ADDRESS_BITS - 1 downto 0),
      write_data_i    => data_i(SPHERE_BITS - 1 downto 0),
      read_address_i  => sphere_address(SPHERE_ADDRESS_BITS - 1 downto 0),
      read_data_o     => sphere_word
    );

  plane_memory_i : entity raplas.plane_memory
    generic map (NUM_ROWS => NUM_ROWS, NUM_COLUMNS => NUM_COLUMNS)
    port map (
      clk_i           => clk_i,
      write_i         => write(TARGET_PLANE),
      write_address_i => address_i(LINE_BITS + 1 downto 0),
      write_data_i    => data_i(PLANE_BITS - 1 downto 0),
      bank_i          => bank,
      set_i           => set,
      planes_o        => planes
    );

  tag <= sphere_word(NODE_BITS - 1 downto 0) & step_s2(STEP_BITS - 1 downto 0);

  plane_sphere_i : entity raplas.plane_sphere_subunit
    generic map (NUM_ROWS => NUM_ROWS, NUM_COLUMNS => NUM_COLUMNS, TAG_BITS => TAG_BITS,
                 GUARD_BITS => GUARD_BITS)
    port map (
      clk_i          => clk_i,
      rst_i          => rst_i,
      valid_i        => step_s2(STEP_BITS),
      ball_i         => sphere_word(SPHERE_BITS - 1 downto NODE_BITS),
      planes_i       => planes,
      tag_i          => tag,
      valid_o        => tested,
      row_flags_o    => row_flags,
      column_flags_o => column_flags,
      tag_o          => tag_s12
    );

  decoder_i : entity raplas.plane_sphere_decoder
    generic map (NUM_ROWS => NUM_ROWS, NUM_COLUMNS => NUM_COLUMNS)
    port map (
      clk_i          => clk_i,
      rst_i          => rst_i,
      rows_i         => pencil.rows,
      columns_i      => pencil.columns,
      valid_i        => tested,
      set_i          => tag_s12(LINE_BITS - 1 downto 0),
      last_i         => tag_s12(STEP_BITS - 1),
      leaf_i         => tag_s12(TAG_BITS - 1),
      row_flags_i    => row_flags,
      column_flags_i => column_flags,
      decided_o      => decided,
      leaf_o         => leaf,
      push_o         => push,
      row_mask_o     => row_mask,
      column_mask_o  => column_mask
    );

  node_delay : entity raplas.delay
    generic map (WIDTH => NODE_BITS - 1, STAGES => 1)
    port map (clk_i => clk_i, rst_i => '0', data_i => tag_s12(TAG_BITS - 2 downto STEP_BITS),
              data_o => node_s13);

  -- --------------------------------------------------------------------------
  -- pairs: leaf queue, selector, pair queue, memories, ray_triangle
  -- --------------------------------------------------------------------------
  leaf_in <= node_s13 & row_mask & column_mask;

  leaf_fifo_i : entity raplas.fifo
    generic map (WIDTH => LEAF_BITS, DEPTH_LOG2 => LEAF_FIFO_DEPTH_LOG2)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => leaf,
      data_i  => leaf_in,
      read_i  => selector_ready,
      data_o  => leaf_out,
      valid_o => leaf_valid,
      ready_o => open,
      count_o => leaves
    );

  selector_i : entity raplas.selector
    port map (
      clk_i         => clk_i,
      rst_i         => rst_i,
      valid_i       => leaf_valid,
      first_i       => leaf_out(ID_BITS + MAX_ROWS + MAX_COLUMNS - 1 downto MAX_ROWS + MAX_COLUMNS),
      count_i       => leaf_out(LEAF_BITS - 1 downto ID_BITS + MAX_ROWS + MAX_COLUMNS),
      row_mask_i    => leaf_out(MAX_ROWS + MAX_COLUMNS - 1 downto MAX_COLUMNS),
      column_mask_i => leaf_out(MAX_COLUMNS - 1 downto 0),
      ready_o       => selector_ready,
      valid_o       => selector_valid,
      ray_o         => pair_in(2 * LINE_BITS - 1 downto 0),
      triangle_o    => pair_in(PAIR_BITS - 1 downto 2 * LINE_BITS),
      ready_i       => pair_ready
    );

  pair_fifo_i : entity raplas.fifo
    generic map (WIDTH => PAIR_BITS, DEPTH_LOG2 => PAIR_FIFO_DEPTH_LOG2)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => selector_valid,
      data_i  => pair_in,
      read_i  => issue,
      data_o  => pair_out,
      valid_o => pair_valid,
      ready_o => pair_ready,
      count_o => open
    );

  issue_i : entity raplas.pair_issue
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      valid_i => pair_valid,
      ray_i   => pair_out(2 * LINE_BITS - 1 downto 0),
      issue_o => issue,
      stall_o => stall
    );

  issue_s0(0) <= issue;

  issue_delay : entity raplas.delay
    generic map (WIDTH => 1, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => issue_s0, data_o => issue_s2);

  pair_delay : entity raplas.delay
    generic map (WIDTH => PAIR_BITS, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_out, data_o => pair_s2);

  ray_address <= bank & pair_out(2 * LINE_BITS - 1 downto 0);

  ray_memory_i : entity raplas.ram
    generic map (WIDTH => RAY_BITS, ADDRESS_BITS => 2 * LINE_BITS + 1)
    port map (
      clk_i           => clk_i,
      write_i         => write(TARGET_RAY),
      write_address_i => address_i(2 * LINE_BITS downto 0),
      write_data_i    => data_i(RAY_BITS - 1 downto 0),
      read_address_i  => ray_address,
      read_data_o     => ray_word
    );

  triangle_memory_i : entity raplas.ram
    generic map (WIDTH => TRIANGLE_BITS, ADDRESS_BITS => TRIANGLE_ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write(TARGET_TRIANGLE),
      write_address_i => address_i(TRIANGLE_ADDRESS_BITS - 1 downto 0),
      write_data_i    => data_i,
      read_address_i  => pair_out(2 * LINE_BITS + TRIANGLE_ADDRESS_BITS - 1 downto 2 * LINE_BITS),
      read_data_o     => triangle_word
    );

  ray_triangle_i : entity raplas.ray_triangle
    generic map (GUARD_BITS => GUARD_BITS)
    port map (
      clk_i         => clk_i,
      rst_i         => rst_i,
      valid_i       => issue_s2(0),
      ray_i         => pair_s2(2 * LINE_BITS - 1 downto 0),
      triangle_id_i => pair_s2(PAIR_BITS - 1 downto 2 * LINE_BITS),
      triangle_i    => triangle_word,
      direction_i   => ray_word,
      origin_i      => origin,
      best_ray_o    => best_ray,
      best_i        => best,
      valid_o       => pair_done,
      hit_o         => hit,
      write_o       => stored,
      first_o       => first_hit,
      ray_o         => stored_ray,
      result_o      => stored_result
    );

  -- two of the banks are used
  result_bank <= '0' & bank;
  host_ray    <= '0' & result_ray_i;

  result_memory_i : entity raplas.result_memory
    port map (
      clk_i        => clk_i,
      clear_i      => starting,
      clear_bank_i => result_bank,
      write_i      => stored,
      write_bank_i => result_bank,
      write_ray_i  => stored_ray,
      write_data_i => stored_result,
      best_bank_i  => result_bank,
      best_ray_i   => best_ray,
      best_o       => best,
      host_ray_i   => host_ray,
      host_data_o  => result_o,
      hit_rows_o   => open
    );

  -- --------------------------------------------------------------------------
  -- ports
  -- --------------------------------------------------------------------------
  busy_o          <= busy;
  request_o       <= request;
  sphere_o        <= sphere_address;
  set_o           <= set;
  decided_o       <= decided;
  leaf_o          <= leaf;
  push_o          <= push;
  row_mask_o      <= row_mask;
  column_mask_o   <= column_mask;
  issue_o         <= issue;
  stall_o         <= stall;
  ray_o           <= pair_out(2 * LINE_BITS - 1 downto 0);
  triangle_o      <= pair_out(PAIR_BITS - 1 downto 2 * LINE_BITS);
  pair_done_o     <= pair_done;
  hit_o           <= hit;
  stored_o        <= stored;
  stored_ray_o    <= stored_ray;
  stored_result_o <= stored_result;

end architecture rtl;
