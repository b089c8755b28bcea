-- ============================================================================
-- hit_queue - from valid hits to nearest hits, a ray never too soon
-- ----------------------------------------------------------------------------
--   @0  front word goes: its best hit is asked for          fifo, pair_issue
--   @2  best hit arrives
--   @5  nearer: to be written                               nearest_hit
-- The nearest hit of a ray is read and written back within 6 clocks: until then
-- the next hit of that bank and ray waits, and those behind it. Tokens, which
-- end a pencil, always go; done_o comes behind all writes of words before it.
-- Pairs are stalled when half the queue is full. Four DSP48, or two with
-- EXPONENT_DSP = false.
-- model: cmodel/include/raplas/hit_queue.hpp     tests: tb/unit/hit_queue
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library raplas;
use raplas.raplas_constants.all;

entity hit_queue is
  generic (
    EXPONENT_DSP : boolean := true   -- false: exponents are added in fabric
  );
  port (
    clk_i        : in  std_ulogic;
    rst_i        : in  std_ulogic;
    valid_i      : in  std_ulogic;                                    -- a valid hit
    last_i       : in  std_ulogic;                                    -- or a token for bank_i
    bank_i       : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    ray_i        : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    triangle_i   : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    t_i          : in  fp24_t;
    d_i          : in  fp24_t;
    u_i          : in  fp24_t;
    v_i          : in  fp24_t;
    bound_i      : in  std_ulogic_vector(DEPTH_BITS - 1 downto 0);    -- of the ray, if it is stored
    stall_o      : out std_ulogic;                                    -- half full: no more pairs
    best_bank_o  : out std_ulogic_vector(BANK_BITS - 1 downto 0);     -- whose best hit is wanted
    best_ray_o   : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    best_i       : in  result_word_t;                                 -- MEMORY_STAGES later
    write_o      : out std_ulogic;                                    -- result_o is to be stored
    write_bank_o : out std_ulogic_vector(BANK_BITS - 1 downto 0);     -- with write_o, up to bound_o
    ray_o        : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    result_o     : out result_word_t;
    first_o      : out std_ulogic;                                    -- the ray had no hit; else 0
    bound_o      : out std_ulogic_vector(DEPTH_BITS - 1 downto 0);
    done_o       : out std_ulogic;                                    -- a token passed
    done_bank_o  : out std_ulogic_vector(BANK_BITS - 1 downto 0)      -- with done_o
  );
end entity hit_queue;

architecture rtl of hit_queue is

  constant PLACE_BITS    : positive := BANK_BITS + 2 * LINE_BITS;   -- bank, ray
  constant SOLUTION_BITS : positive := ID_BITS + 4 * FP_BITS;   -- triangle, t' d u' v'
  constant WORD_BITS     : positive := PLACE_BITS + SOLUTION_BITS + DEPTH_BITS;
  constant PLACE_LSB     : positive := SOLUTION_BITS + DEPTH_BITS;
  constant D_LSB         : positive := DEPTH_BITS + 2 * FP_BITS;
  constant T_LSB         : positive := D_LSB + FP_BITS;
  constant ID_LSB        : positive := T_LSB + FP_BITS;

  subtype word_t is std_ulogic_vector(WORD_BITS - 1 downto 0);   -- place, solution, bound

  signal write     : std_ulogic;
  signal queue_in  : std_ulogic_vector(WORD_BITS downto 0);   -- token, word
  signal queue_out : std_ulogic_vector(WORD_BITS downto 0);
  signal waits     : std_ulogic;
  signal count     : std_ulogic_vector(HIT_FIFO_DEPTH_LOG2 downto 0);

  signal hit_waits : std_ulogic;
  signal issue     : std_ulogic;
  signal token     : std_ulogic;
  signal taken     : std_ulogic;

  signal word_s0  : word_t;
  signal word_s2  : word_t;
  signal word_s5  : word_t;
  signal event_s0 : std_ulogic_vector(1 downto 0);   -- hit, token
  signal event_s5 : std_ulogic_vector(1 downto 0);
  signal nearer   : std_ulogic;
  signal first    : std_ulogic;

begin

  write    <= valid_i or last_i;
  queue_in <= last_i & bank_i & ray_i & triangle_i & t_i & d_i & u_i & v_i & bound_i;

  queue_i : entity raplas.fifo
    generic map (WIDTH => WORD_BITS + 1, DEPTH_LOG2 => HIT_FIFO_DEPTH_LOG2)
    port map (clk_i => clk_i, rst_i => rst_i, write_i => write, data_i => queue_in, read_i => taken,
              data_o => queue_out, valid_o => waits, ready_o => open, count_o => count);

  stall_o <= count(HIT_FIFO_DEPTH_LOG2) or count(HIT_FIFO_DEPTH_LOG2 - 1);

  -- s0: the front word
  word_s0   <= queue_out(WORD_BITS - 1 downto 0);
  hit_waits <= waits and not queue_out(WORD_BITS);
  token     <= waits and queue_out(WORD_BITS);
  taken     <= issue or token;
  event_s0  <= issue & token;

  issue_i : entity raplas.pair_issue
    generic map (RAY_BITS => PLACE_BITS)
    port map (clk_i => clk_i, rst_i => rst_i, valid_i => hit_waits,
              ray_i => word_s0(WORD_BITS - 1 downto PLACE_LSB), issue_o => issue, stall_o => open);

  best_bank_o <= word_s0(WORD_BITS - 1 downto PLACE_LSB + 2 * LINE_BITS);
  best_ray_o  <= word_s0(PLACE_LSB + 2 * LINE_BITS - 1 downto PLACE_LSB);

  -- s2: its best hit
  word_2_delay : entity raplas.delay
    generic map (WIDTH => WORD_BITS, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => word_s0, data_o => word_s2);

  nearest_i : entity raplas.nearest_hit
    generic map (EXPONENT_DSP => EXPONENT_DSP)
    port map (
      clk_i      => clk_i,
      t_i        => word_s2(ID_LSB - 1 downto T_LSB),
      d_i        => word_s2(T_LSB - 1 downto D_LSB),
      triangle_i => word_s2(PLACE_LSB - 1 downto ID_LSB),
      best_i     => best_i,
      nearer_o   => nearer,
      first_o    => first
    );

  -- s5: decided
  word_5_delay : entity raplas.delay
    generic map (WIDTH => WORD_BITS, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => word_s2, data_o => word_s5);

  event_delay : entity raplas.delay
    generic map (WIDTH => 2, STAGES => MEMORY_STAGES + MUL_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => event_s0, data_o => event_s5);

  write_o      <= event_s5(1) and nearer;
  write_bank_o <= word_s5(WORD_BITS - 1 downto PLACE_LSB + 2 * LINE_BITS);
  ray_o        <= word_s5(PLACE_LSB + 2 * LINE_BITS - 1 downto PLACE_LSB);
  result_o     <= '1' & word_s5(PLACE_LSB - 1 downto DEPTH_BITS);
  first_o      <= event_s5(1) and first;
  bound_o      <= word_s5(DEPTH_BITS - 1 downto 0);
  done_o       <= event_s5(0);
  done_bank_o  <= word_s5(WORD_BITS - 1 downto PLACE_LSB + 2 * LINE_BITS);

end architecture rtl;
