-- ============================================================================
-- hit_queue - from valid hits to nearest hits, a ray never too soon
-- ----------------------------------------------------------------------------
--   @0  front word goes: its best hit is asked for          fifo, pair_issue
--   @2  best hit arrives
--   @5  nearer, or a rival of it: to be written             nearest_hit
-- The nearest hit of a ray is read and written back within 6 clocks: until then
-- the next hit of that bank and ray waits, and those behind it. Tokens, which
-- end a pencil, always go; done_o comes behind all writes of words before it.
-- Pairs are stalled when half the queue is full. Of certified hits, which are only
-- possible, the word of a ray also keeps one that may be nearer than the nearest, a
-- rival, and says if there are more (docs/hit_queue.md). Four DSP48, or two with
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
    bound_i      : in  std_ulogic_vector(DEPTH_BITS - 1 downto 0);    -- of the ray, if nearest
    certify_i    : in  std_ulogic;                                    -- it is only possible
    rough_i      : in  std_ulogic;                                    -- its depth is known roughly,
    unsure_i     : in  std_ulogic;                                    -- or not at all
    ends_i       : in  std_ulogic;                                    -- two such are enough
    stall_o      : out std_ulogic;                                    -- half full: no more pairs
    best_bank_o  : out std_ulogic_vector(BANK_BITS - 1 downto 0);     -- whose best hit is wanted
    best_ray_o   : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    best_i       : in  ray_hits_word_t;                               -- MEMORY_STAGES later
    write_o      : out std_ulogic;                                    -- result_o is to be stored
    write_bank_o : out std_ulogic_vector(BANK_BITS - 1 downto 0);     -- with write_o, up to bound_o
    ray_o        : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    result_o     : out ray_hits_word_t;
    first_o      : out std_ulogic;                                    -- the ray had no hit; else 0
    bounds_o     : out std_ulogic;                                    -- bound_o, too; else 0
    bound_o      : out std_ulogic_vector(DEPTH_BITS - 1 downto 0);
    done_o       : out std_ulogic;                                    -- a token passed
    done_bank_o  : out std_ulogic_vector(BANK_BITS - 1 downto 0)      -- with done_o
  );
end entity hit_queue;

architecture rtl of hit_queue is

  constant PLACE_BITS    : positive := BANK_BITS + 2 * LINE_BITS;   -- bank, ray
  constant SOLUTION_BITS : positive := ID_BITS + 4 * FP_BITS;   -- triangle, t' d u' v'
  constant FLAG_BITS     : positive := 4;                       -- certify rough unsure ends
  constant SOLUTION_LSB  : positive := FLAG_BITS + DEPTH_BITS;
  constant PLACE_LSB     : positive := SOLUTION_LSB + SOLUTION_BITS;
  constant WORD_BITS     : positive := PLACE_LSB + PLACE_BITS;
  constant D_LSB         : positive := SOLUTION_LSB + 2 * FP_BITS;
  constant T_LSB         : positive := D_LSB + FP_BITS;
  constant ID_LSB        : positive := T_LSB + FP_BITS;
  constant CERTIFY       : natural  := 3;
  constant ROUGH         : natural  := 2;
  constant UNSURE        : natural  := 1;
  constant ENDS          : natural  := 0;

  subtype word_t is std_ulogic_vector(WORD_BITS - 1 downto 0);   -- place, solution, bound, flags
  subtype id_t is std_ulogic_vector(ID_BITS - 1 downto 0);

  -- what a ray's word is to a hit; nothing of it without a best hit
  constant KEPT_BITS     : positive := 7 + ID_BITS;
  constant KNOWN         : natural  := ID_BITS + 6;   -- certified, and in the word or one too many
  constant SECOND        : natural  := ID_BITS + 5;   -- certified, and not the first
  constant LOOSE         : natural  := ID_BITS + 4;   -- and its depth or the best hit's isn't known
  constant BEST_ROUGH    : natural  := ID_BITS + 3;
  constant BEST_UNSURE   : natural  := ID_BITS + 2;
  constant RIVAL         : natural  := ID_BITS + 1;
  constant RIVAL_ROUGH   : natural  := ID_BITS;       -- below: the rival

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
  signal tie       : std_ulogic;
  signal rough_tie : std_ulogic;
  signal first    : std_ulogic;

  signal best        : ray_hits_t;
  signal best_result : result_word_t;
  signal kept_s2     : std_ulogic_vector(KEPT_BITS - 1 downto 0);
  signal kept_s5     : std_ulogic_vector(KEPT_BITS - 1 downto 0);
  signal solution_s2 : std_ulogic_vector(SOLUTION_BITS - 1 downto 0);   -- of the best hit
  signal solution_s5 : std_ulogic_vector(SOLUTION_BITS - 1 downto 0);

begin

  write    <= valid_i or last_i;
  queue_in <= last_i & bank_i & ray_i & triangle_i & t_i & d_i & u_i & v_i & bound_i
    & certify_i & rough_i & unsure_i & ends_i;

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

  best        <= unpack_ray_hits(best_i);
  solution_s2 <= best_i(SOLUTION_BITS - 1 downto 0);
  best_result <= best.hit & solution_s2;

  kept_p : process (best, word_s2)
    variable triangle_v : id_t;
    variable second_v   : std_ulogic;
  begin
    triangle_v := word_s2(PLACE_LSB - 1 downto ID_LSB);
    second_v   := word_s2(CERTIFY) and best.hit;
    kept_s2    <= (others => '0');
    if best.crowd = '1' or triangle_v = best.triangle
       or (best.rival = '1' and triangle_v = best.rival_triangle) then
      kept_s2(KNOWN) <= second_v;
    end if;
    kept_s2(SECOND) <= second_v;
    kept_s2(LOOSE)  <= second_v and (word_s2(UNSURE) or best.unsure);
    if best.hit = '1' then
      kept_s2(BEST_ROUGH)           <= best.rough;
      kept_s2(BEST_UNSURE)          <= best.unsure;
      kept_s2(RIVAL)                <= best.rival;
      kept_s2(RIVAL_ROUGH)          <= best.rival_rough;
      kept_s2(ID_BITS - 1 downto 0) <= best.rival_triangle;
    end if;
  end process kept_p;

  nearest_i : entity raplas.nearest_hit
    generic map (EXPONENT_DSP => EXPONENT_DSP)
    port map (
      clk_i      => clk_i,
      t_i        => word_s2(ID_LSB - 1 downto T_LSB),
      d_i        => word_s2(T_LSB - 1 downto D_LSB),
      triangle_i => word_s2(PLACE_LSB - 1 downto ID_LSB),
      best_i     => best_result,
      nearer_o   => nearer,
      tie_o      => tie,
      rough_tie_o => rough_tie,
      first_o    => first
    );

  -- s5: decided
  word_5_delay : entity raplas.delay
    generic map (WIDTH => WORD_BITS, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => word_s2, data_o => word_s5);

  event_delay : entity raplas.delay
    generic map (WIDTH => 2, STAGES => MEMORY_STAGES + MUL_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => event_s0, data_o => event_s5);

  kept_5_delay : entity raplas.delay
    generic map (WIDTH => KEPT_BITS, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => kept_s2, data_o => kept_s5);

  solution_5_delay : entity raplas.delay
    generic map (WIDTH => SOLUTION_BITS, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => solution_s2, data_o => solution_s5);

  decided_p : process (event_s5, word_s5, kept_s5, solution_s5, nearer, tie, rough_tie,
                       first)
    variable open_v    : std_ulogic;   -- of the hit and the best one, either may be nearer
    variable nearest_v : std_ulogic;
    variable crowd_v   : std_ulogic;
    variable ended_v   : std_ulogic;
    variable write_v   : std_ulogic;
    variable result_v  : ray_hits_word_t;
    variable fields_v  : ray_hits_t;
  begin
    open_v := kept_s5(LOOSE) or (kept_s5(SECOND) and tie);
    if word_s5(ROUGH) = '1' or kept_s5(BEST_ROUGH) = '1' then
      open_v := kept_s5(LOOSE) or (kept_s5(SECOND) and rough_tie);
    end if;
    nearest_v := nearer;
    if kept_s5(LOOSE) = '1' then   -- a known depth is kept
      nearest_v := not word_s5(UNSURE);
    end if;
    crowd_v := open_v and kept_s5(RIVAL);
    ended_v := crowd_v or (open_v and word_s5(ENDS));
    write_v := event_s5(1) and (open_v or nearest_v) and not kept_s5(KNOWN);

    result_v := (others => '0');
    result_v(SOLUTION_BITS - 1 downto 0) := solution_s5;
    if nearest_v = '1' then
      result_v(SOLUTION_BITS - 1 downto 0) := word_s5(PLACE_LSB - 1 downto SOLUTION_LSB);
    end if;
    fields_v        := unpack_ray_hits(result_v);
    fields_v.hit    := '1';
    fields_v.crowd  := crowd_v;
    fields_v.rough  := kept_s5(BEST_ROUGH);
    fields_v.unsure := kept_s5(BEST_UNSURE);
    if nearest_v = '1' then
      fields_v.rough  := word_s5(ROUGH);
      fields_v.unsure := word_s5(UNSURE);
    end if;
    fields_v.rival          := kept_s5(RIVAL) and kept_s5(RIVAL_ROUGH);
    fields_v.rival_rough    := kept_s5(RIVAL_ROUGH);
    fields_v.rival_triangle := kept_s5(ID_BITS - 1 downto 0);
    if open_v = '1' then
      fields_v.rival          := '1';
      fields_v.rival_rough    := word_s5(ROUGH) or word_s5(UNSURE);
      fields_v.rival_triangle := word_s5(PLACE_LSB - 1 downto ID_LSB);
      if nearest_v = '1' then
        fields_v.rival_rough    := kept_s5(BEST_ROUGH) or kept_s5(BEST_UNSURE);
        fields_v.rival_triangle := solution_s5(SOLUTION_BITS - 1 downto 4 * FP_BITS);
      end if;
    end if;

    write_o  <= write_v;
    result_o <= pack_ray_hits(fields_v);
    first_o  <= event_s5(1) and first;
    bounds_o <= write_v and (nearest_v or ended_v);
    bound_o  <= word_s5(SOLUTION_LSB - 1 downto FLAG_BITS);
    if ended_v = '1' then
      bound_o <= (others => '0');
    end if;
  end process decided_p;

  write_bank_o <= word_s5(WORD_BITS - 1 downto PLACE_LSB + 2 * LINE_BITS);
  ray_o        <= word_s5(PLACE_LSB + 2 * LINE_BITS - 1 downto PLACE_LSB);
  done_o       <= event_s5(0);
  done_bank_o  <= word_s5(WORD_BITS - 1 downto PLACE_LSB + 2 * LINE_BITS);

end architecture rtl;
