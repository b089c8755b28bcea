-- ============================================================================
-- pair_half - from triangles and their rectangles to the hits of the rays
-- ----------------------------------------------------------------------------
--   triangle queue -> edge_setup -> queue of cut triangles
--     -> row_selector -> row queue -> column_selector
--   @0   pair: addresses of its ray and triangle
--   @2   their words                             Ray, Triangle memory
--   @28  hit? t', d, u', v'                      ray_solver; depth_quotient
--        -> hit_queue -> Result memory, ray_bounds
-- A pair counts as a hit if Moeller's test says so and its depth code is neither
-- less than that of the triangle's nearest point nor too far for the pencil; a
-- certified one unless its depth is known and too far.
-- model: cmodel/include/raplas/raplas_unit.hpp     tests: tb/integration/raplas_unit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;
use raplas.pair_selection_pkg.all;

entity pair_half is
  generic (
    GUARD_BITS            : natural range 0 to 2 := 2;
    TRIANGLE_ADDRESS_BITS : positive range 1 to ID_BITS := 12
  );
  port (
    clk_i            : in  std_ulogic;
    rst_i            : in  std_ulogic;
    -- host: memories
    write_ray_i      : in  std_ulogic;
    write_triangle_i : in  std_ulogic;
    address_i        : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    data_i           : in  std_ulogic_vector(TRIANGLE_BITS - 1 downto 0);
    result_ray_i     : in  std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - 1 downto 0);
    result_o         : out ray_hits_word_t;                         -- MEMORY_STAGES later
    hit_rows_o       : out std_ulogic_vector(PENCIL_BANKS * MAX_ROWS - 1 downto 0);
    -- registers of all banks, bank k in the k-th place from the low end
    pencils_i        : in  std_ulogic_vector(PENCIL_BANKS * PENCIL_BITS - 1 downto 0);
    limits_i         : in  std_ulogic_vector(PENCIL_BANKS * LIMITS_BITS - 1 downto 0);
    -- a pencil that is to be walked later: bounds and hit bits of its rays
    clear_i          : in  std_ulogic;
    clear_bank_i     : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    clear_rows_i     : in  std_ulogic_vector(LINE_BITS downto 0);
    clear_far_i      : in  std_ulogic_vector(DEPTH_BITS - 1 downto 0);
    -- the pencil whose turn it is to be walked
    walk_bank_i      : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    row_bounds_o     : out std_ulogic_vector(MAX_ROWS * DEPTH_BITS - 1 downto 0);   -- of its rays
    -- triangles of that pencil, and its end
    valid_i          : in  std_ulogic;
    word_i           : in  queued_triangle_word_t;
    triangles_o      : out std_ulogic_vector(TRIANGLE_FIFO_DEPTH_LOG2 downto 0);    -- in the queue
    -- the end of a pencil: all its results are in place
    done_o           : out std_ulogic;
    done_bank_o      : out std_ulogic_vector(BANK_BITS - 1 downto 0);
    -- for counters and traces
    issue_o          : out std_ulogic;                              -- a pair goes
    ray_o            : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    pair_triangle_o  : out std_ulogic_vector(ID_BITS - 1 downto 0);
    stall_o          : out std_ulogic;                              -- none may go
    hit_o            : out std_ulogic;                              -- @28
    first_hit_o      : out std_ulogic;                              -- a ray has its first hit
    stored_o         : out std_ulogic;
    stored_ray_o     : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    stored_result_o  : out ray_hits_word_t
  );
end entity pair_half;

architecture rtl of pair_half is

  constant SOLVER_STAGES : positive := 2 * MUL_STAGES + 5 * ADD_STAGES;   -- 26
  constant PAIR_BITS : positive := BANK_BITS + ID_BITS + DEPTH_BITS + 2 * LINE_BITS;
  constant VECTOR_BITS : positive := 3 * FP_BITS;

  subtype ray_id_t is std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
  subtype id_t is std_ulogic_vector(ID_BITS - 1 downto 0);

  -- triangle queue to column_selector
  signal word_valid, word_ready : std_ulogic;
  signal word_out              : queued_triangle_word_t;
  signal front_bank            : bank_t;
  signal front_bounds, bounds  : line_bounds_t;
  signal row_hit               : std_ulogic;
  signal front_limits          : limits_t;
  signal cut_write, cut_valid, cut_ready : std_ulogic;
  signal cut_in, cut_out       : cut_triangle_word_t;
  signal cut_count             : std_ulogic_vector(CUT_FIFO_DEPTH_LOG2 downto 0);
  signal read                  : std_ulogic;
  signal read_bank             : bank_t;
  signal read_row              : line_t;
  signal row_write, row_valid, row_ready : std_ulogic;
  signal row_in, row_out       : queued_row_word_t;
  signal row_count             : std_ulogic_vector(ROW_FIFO_DEPTH_LOG2 downto 0);
  -- pairs
  signal issue, last, stall    : std_ulogic;
  signal ray                   : ray_id_t;
  signal triangle              : id_t;
  signal z                     : depth_t;
  signal bank                  : bank_t;
  signal event_s0, event_s2, event_s28 : std_ulogic_vector(1 downto 0);   -- issue last
  signal pair_s0, pair_s2, pair_s28    : std_ulogic_vector(PAIR_BITS - 1 downto 0);
  signal ray_address           : std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - 1 downto 0);
  signal ray_word              : ray_word_t;
  signal triangle_word         : triangle_word_t;
  signal bank_s2, bank_s28     : bank_t;
  signal pencil                : pencil_t;
  signal origin                : std_ulogic_vector(VECTOR_BITS - 1 downto 0);
  signal band                  : fp24_t;
  signal limits                : limits_t;
  -- @28
  signal solver_valid, solver_hit, solver_unsure : std_ulogic;
  signal hit, certify, rough, unsure, ends       : std_ulogic;
  signal t, d, u, v            : fp24_t;
  signal t_early, d_early      : fp24_t;     -- @24
  signal quotient              : depth_t;
  signal bound                 : depth_t;
  -- results
  signal best_bank, stored_bank : bank_t;
  signal best_ray, stored_ray  : ray_id_t;
  signal best, stored_result   : ray_hits_word_t;
  signal stored, first_hit     : std_ulogic;
  signal stored_bounds         : std_ulogic;
  signal stored_bound          : depth_t;
  signal hit_rows              : std_ulogic_vector(PENCIL_BANKS * MAX_ROWS - 1 downto 0);
  signal stored_pencil         : pencil_t;
  signal stored_limits         : limits_t;

begin

  -- --------------------------------------------------------------------------
  -- from triangles to pairs
  -- --------------------------------------------------------------------------
  triangle_fifo_i : entity raplas.block_fifo
    generic map (WIDTH => QUEUED_TRIANGLE_BITS, DEPTH_LOG2 => TRIANGLE_FIFO_DEPTH_LOG2)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => valid_i,
      data_i  => word_i,
      read_i  => word_ready,
      data_o  => word_out,
      valid_o => word_valid,
      ready_o => open,
      count_o => triangles_o
    );

  edges_e : entity raplas.edge_setup
    port map (
      clk_i        => clk_i,
      rst_i        => rst_i,
      valid_i      => word_valid,
      word_i       => word_out,
      ready_o      => word_ready,
      pair_bank_o  => front_bank,
      row_bounds_i => front_bounds,
      error_i      => front_limits.error,
      valid_o      => cut_write,
      word_o       => cut_in,
      count_i      => cut_count
    );

  cut_fifo_i : entity raplas.block_fifo
    generic map (WIDTH => CUT_TRIANGLE_BITS, DEPTH_LOG2 => CUT_FIFO_DEPTH_LOG2)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => cut_write,
      data_i  => cut_in,
      read_i  => cut_ready,
      data_o  => cut_out,
      valid_o => cut_valid,
      ready_o => open,
      count_o => cut_count
    );

  rows_e : entity raplas.row_selector
    port map (
      clk_i       => clk_i,
      rst_i       => rst_i,
      valid_i     => cut_valid,
      word_i      => cut_out,
      ready_o     => cut_ready,
      read_o      => read,
      bank_o      => read_bank,
      row_o       => read_row,
      bounds_i    => bounds,
      row_hit_i   => row_hit,
      row_valid_o => row_write,
      row_word_o  => row_in,
      row_count_i => row_count
    );

  row_fifo_i : entity raplas.fifo
    generic map (WIDTH => QUEUED_ROW_BITS, DEPTH_LOG2 => ROW_FIFO_DEPTH_LOG2)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => row_write,
      data_i  => row_in,
      read_i  => row_ready,
      data_o  => row_out,
      valid_o => row_valid,
      ready_o => open,
      count_o => row_count
    );

  columns_e : entity raplas.column_selector
    port map (
      clk_i      => clk_i,
      rst_i      => rst_i,
      valid_i    => row_valid,
      row_word_i => row_out,
      ready_o    => row_ready,
      stall_i    => stall,
      issue_o    => issue,
      ray_o      => ray,
      triangle_o => triangle,
      z_o        => z,
      bank_o     => bank,
      last_o     => last
    );

  bounds_e : entity raplas.ray_bounds
    port map (
      clk_i             => clk_i,
      rst_i             => rst_i,
      clear_i           => clear_i,
      clear_bank_i      => clear_bank_i,
      clear_rows_i      => clear_rows_i,
      clear_far_i       => clear_far_i,
      hit_rows_i        => hit_rows,
      update_i          => stored_bounds,
      update_bank_i     => stored_bank,
      update_columns_i  => stored_pencil.columns,
      update_far_i      => stored_limits.far,
      update_ray_i      => stored_ray,
      update_bound_i    => stored_bound,
      read_i            => read,
      read_bank_i       => read_bank,
      read_row_i        => read_row,
      bounds_o          => bounds,
      row_hit_o         => row_hit,
      walk_bank_i       => walk_bank_i,
      row_bounds_o      => row_bounds_o,
      pair_bank_i       => front_bank,
      pair_row_bounds_o => front_bounds
    );

  -- --------------------------------------------------------------------------
  -- from pairs to hits
  -- --------------------------------------------------------------------------
  event_s0    <= issue & last;
  pair_s0     <= bank & triangle & z & ray;
  ray_address <= bank & ray;

  event_delay_2 : entity raplas.delay
    generic map (WIDTH => 2, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => event_s0, data_o => event_s2);

  pair_delay_2 : entity raplas.delay
    generic map (WIDTH => PAIR_BITS, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s0, data_o => pair_s2);

  event_delay_28 : entity raplas.delay
    generic map (WIDTH => 2, STAGES => SOLVER_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => event_s2, data_o => event_s28);

  pair_delay_28 : entity raplas.delay
    generic map (WIDTH => PAIR_BITS, STAGES => SOLVER_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s2, data_o => pair_s28);

  ray_memory_i : entity raplas.ray_memory
    port map (
      clk_i          => clk_i,
      write_i        => write_ray_i,
      write_group_i  => address_i(BANK_BITS + 2 * LINE_BITS - WORD_RAYS_LOG2 - 1 downto 0),
      write_data_i   => data_i(2 ** WORD_RAYS_LOG2 * RAY_BITS - 1 downto 0),
      read_address_i => ray_address,
      read_data_o    => ray_word
    );

  triangle_memory_i : entity raplas.ram
    generic map (WIDTH => TRIANGLE_BITS, ADDRESS_BITS => TRIANGLE_ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write_triangle_i,
      write_address_i => address_i(TRIANGLE_ADDRESS_BITS - 1 downto 0),
      write_data_i    => data_i,
      read_address_i  => triangle(TRIANGLE_ADDRESS_BITS - 1 downto 0),
      read_data_o     => triangle_word
    );

  bank_s2  <= pair_s2(PAIR_BITS - 1 downto PAIR_BITS - BANK_BITS);
  bank_s28 <= pair_s28(PAIR_BITS - 1 downto PAIR_BITS - BANK_BITS);

  registers_p : process (pencils_i, limits_i, front_bank, bank_s2, bank_s28, stored_bank)
    variable pencil_v : pencil_t;
    variable limits_v : limits_t;
  begin
    for k in 0 to PENCIL_BANKS - 1 loop
      pencil_v := unpack_pencil(pencils_i((k + 1) * PENCIL_BITS - 1 downto k * PENCIL_BITS));
      limits_v := unpack_limits(limits_i((k + 1) * LIMITS_BITS - 1 downto k * LIMITS_BITS));
      if k = 0 or unsigned(front_bank) = k then
        front_limits <= limits_v;
      end if;
      if k = 0 or unsigned(bank_s2) = k then
        pencil <= pencil_v;
        band   <= limits_v.band;
      end if;
      if k = 0 or unsigned(bank_s28) = k then
        limits <= limits_v;
      end if;
      if k = 0 or unsigned(stored_bank) = k then
        stored_pencil <= pencil_v;
        stored_limits <= limits_v;
      end if;
    end loop;
  end process registers_p;

  origin <= pencil.ox & pencil.oy & pencil.oz;

  solver_i : entity raplas.ray_solver
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => false)
    port map (
      clk_i       => clk_i,
      rst_i       => rst_i,
      valid_i     => event_s2(1),
      triangle_i  => triangle_word,
      direction_i => ray_word,
      origin_i    => origin,
      band_i      => band,
      valid_o     => solver_valid,
      hit_o       => solver_hit,
      t_o         => t,
      d_o         => d,
      u_o         => u,
      v_o         => v,
      rough_o     => rough,
      unsure_o    => solver_unsure,
      t_s22_o     => t_early,
      d_s22_o     => d_early
    );

  quotient_i : entity raplas.depth_quotient
    port map (clk_i => clk_i, t_i => t_early, d_i => d_early, q_o => quotient);

  certify <= '0' when is_zero(limits.band) else '1';
  ends    <= certify and limits.any_hit;   -- whichever hits come first will do
  unsure  <= solver_unsure or ends;

  valid_hit_p : process (solver_hit, solver_unsure, quotient, limits, certify, rough, unsure,
                         pair_s28)
    variable z_v     : depth_t;
    variable bound_v : unsigned(DEPTH_BITS downto 0);
  begin
    z_v := pair_s28(2 * LINE_BITS + DEPTH_BITS - 1 downto 2 * LINE_BITS);
    hit <= '0';
    if solver_unsure = '1'
       or ((certify = '1' or unsigned(z_v) <= unsigned(quotient))
           and unsigned(quotient) < unsigned(limits.far)) then
      hit <= solver_hit;
    end if;
    bound_v := unsigned('0' & quotient) + QUOTIENT_ERROR;
    if certify = '1' then
      bound_v := unsigned('0' & quotient) + QUOTIENT_ERROR + BOUND_MARGIN;
      if rough = '1' then
        bound_v := unsigned('0' & quotient) + QUOTIENT_ERROR + ROUGH_BOUND_MARGIN;
      end if;
    end if;
    bound <= std_ulogic_vector(bound_v(DEPTH_BITS - 1 downto 0));
    if unsure = '1' then
      bound <= limits.far;
    elsif limits.any_hit = '1' then
      bound <= (others => '0');
    elsif bound_v(DEPTH_BITS) = '1' then
      bound <= (others => '1');
    end if;
  end process valid_hit_p;

  hits_e : entity raplas.hit_queue
    generic map (EXPONENT_DSP => false)
    port map (
      clk_i        => clk_i,
      rst_i        => rst_i,
      valid_i      => hit,
      last_i       => event_s28(0),
      bank_i       => bank_s28,
      ray_i        => pair_s28(2 * LINE_BITS - 1 downto 0),
      triangle_i   => pair_s28(2 * LINE_BITS + DEPTH_BITS + ID_BITS - 1
                               downto 2 * LINE_BITS + DEPTH_BITS),
      t_i          => t,
      d_i          => d,
      u_i          => u,
      v_i          => v,
      bound_i      => bound,
      certify_i    => certify,
      rough_i      => rough,
      unsure_i     => unsure,
      ends_i       => ends,
      stall_o      => stall,
      best_bank_o  => best_bank,
      best_ray_o   => best_ray,
      best_i       => best,
      write_o      => stored,
      write_bank_o => stored_bank,
      ray_o        => stored_ray,
      result_o     => stored_result,
      first_o      => first_hit,
      bounds_o     => stored_bounds,
      bound_o      => stored_bound,
      done_o       => done_o,
      done_bank_o  => done_bank_o
    );

  result_memory_i : entity raplas.result_memory
    generic map (WIDTH => RAY_HITS_BITS)
    port map (
      clk_i        => clk_i,
      clear_i      => clear_i,
      clear_bank_i => clear_bank_i,
      write_i      => stored,
      write_bank_i => stored_bank,
      write_ray_i  => stored_ray,
      write_data_i => stored_result,
      best_bank_i  => best_bank,
      best_ray_i   => best_ray,
      best_o       => best,
      host_ray_i   => result_ray_i,
      host_data_o  => result_o,
      hit_rows_o   => hit_rows
    );

  hit_rows_o      <= hit_rows;
  issue_o         <= issue;
  ray_o           <= ray;
  pair_triangle_o <= triangle;
  stall_o         <= stall;
  hit_o           <= hit;
  first_hit_o     <= first_hit;
  stored_o        <= stored;
  stored_ray_o    <= stored_ray;
  stored_result_o <= stored_result;

end architecture rtl;
