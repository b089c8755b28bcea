-- ============================================================================
-- row_interval - the columns of a row between the outermost cuts of a triangle's edges
-- ----------------------------------------------------------------------------
--   @1  does the edge reach the row?                       A, B of dsp_multiply_add
--   @3  where it cuts the row: at + floor(line * slope)    MULTIPLY_ADD_STAGES
--   @4  less its margin, and with it
--   @5  the last column in front of the former and the last up to the latter, each
--       held between -9 and 7, from the middle
--   @6  the columns behind the least of the former and up to the greatest of the latter
-- Once for each of the three edges; one that does not reach the row does not count,
-- an open one may cut it anywhere. Exact: no cut leaves its word.
-- model: cmodel/include/raplas/scan_lines.hpp     tests: tb/unit/row_interval
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity row_interval is
  port (
    clk_i     : in  std_ulogic;
    row_i     : in  line_t;
    cuts_i    : in  edge_cuts_word_t;   -- as in the word of a cut triangle
    whole_i   : in  std_ulogic;         -- all columns: the cuts don't count
    columns_o : out line_mask_t         -- @6: ROW_INTERVAL_STAGES
  );
end entity row_interval;

architecture rtl of row_interval is

  constant MIDDLE       : positive := NUM_LINES / 2;
  constant DROPPED_BITS : positive := SLOPE_FRACTION - CUT_FRACTION;   -- of the product
  constant PLACE_BITS   : positive := CUT_BITS + 1;                    -- a cut with its margin
  constant COLUMN_BITS  : positive := PLACE_BITS - CUT_FRACTION;

  subtype column_t is signed(COLUMN_BITS - 1 downto 0);   -- from the middle
  subtype near_t is signed(LINE_BITS downto 0);           -- the same, held between -9 and 7
  constant NEAR_LOW  : near_t := to_signed(-MIDDLE - 1, LINE_BITS + 1);
  constant NEAR_HIGH : near_t := to_signed(MIDDLE - 1, LINE_BITS + 1);

  type edge_t is record
    reaches  : std_ulogic;
    open_cut : std_ulogic;
    margin   : std_ulogic_vector(MARGIN_BITS - 1 downto 0);
  end record;
  type edges_t is array (0 to 2) of edge_t;
  type ats_t is array (0 to 2) of std_ulogic_vector(CUT_BITS - 1 downto 0);
  type sums_t is array (0 to 2) of std_ulogic_vector(47 downto 0);

  type edge_s4_t is record
    reaches  : std_ulogic;
    open_cut : std_ulogic;
    before   : column_t;   -- the last column that is wholly in front
    last     : column_t;
  end record;
  type edges_s4_t is array (0 to 2) of edge_s4_t;

  type edge_s5_t is record
    before : near_t;
    last   : near_t;
  end record;
  type edges_s5_t is array (0 to 2) of edge_s5_t;

  type reg_t is record
    at_s1      : ats_t;
    s1         : edges_t;
    s2         : edges_t;
    s3         : edges_t;
    s4         : edges_s4_t;
    s5         : edges_s5_t;
    columns_s6 : line_mask_t;
  end record;

  signal r    : reg_t;
  signal rin  : reg_t;
  signal cuts : edge_cuts_t;
  signal line : signed(LINE_BITS - 1 downto 0);   -- of the row, from the middle
  signal a    : std_ulogic_vector(17 downto 0);
  signal sum  : sums_t;                           -- @3

  function held(column : column_t) return near_t is
  begin
    if column < NEAR_LOW then
      return NEAR_LOW;
    elsif column > NEAR_HIGH then
      return NEAR_HIGH;
    end if;
    return resize(column, LINE_BITS + 1);
  end function held;

begin

  cuts <= unpack_edge_cuts(cuts_i);
  line <= signed(not row_i(LINE_BITS - 1) & row_i(LINE_BITS - 2 downto 0));
  a    <= std_ulogic_vector(resize(line, 18));

  edges_g : for k in 0 to 2 generate
    signal c : std_ulogic_vector(47 downto 0);
  begin
    c <= std_ulogic_vector(shift_left(resize(signed(r.at_s1(k)), 48), DROPPED_BITS));
    sum_i : entity raplas.dsp_multiply_add
      port map (clk_i => clk_i, a_i => a, b_i => cuts(k).slope, c_i => c, p_o => sum(k));
  end generate edges_g;

  comb_p : process (r, cuts, line, whole_i, sum)
    variable v        : reg_t;
    variable place_v  : signed(PLACE_BITS - 1 downto 0);
    variable margin_v : signed(PLACE_BITS - 1 downto 0);
    variable edge_v   : signed(PLACE_BITS - 1 downto 0);
    variable behind_v : std_ulogic;
    variable up_to_v  : std_ulogic;
  begin
    v := r;

    for k in 0 to 2 loop
      v.at_s1(k)      := cuts(k).at;
      v.s1(k).margin  := cuts(k).margin;
      v.s1(k).reaches := whole_i;
      if signed(cuts(k).first) <= line and line <= signed(cuts(k).last) then
        v.s1(k).reaches := '1';
      end if;
      v.s1(k).open_cut := cuts(k).open_cut or whole_i;
    end loop;
    v.s2 := r.s1;
    v.s3 := r.s2;

    for k in 0 to 2 loop
      v.s4(k).reaches  := r.s3(k).reaches;
      v.s4(k).open_cut := r.s3(k).open_cut;
      place_v  := signed(sum(k)(PLACE_BITS + DROPPED_BITS - 1 downto DROPPED_BITS));
      margin_v := signed(resize(unsigned(r.s3(k).margin), PLACE_BITS));
      edge_v   := place_v + not margin_v;   -- a unit in front of the interval
      v.s4(k).before := edge_v(PLACE_BITS - 1 downto CUT_FRACTION);
      edge_v   := place_v + margin_v;
      v.s4(k).last   := edge_v(PLACE_BITS - 1 downto CUT_FRACTION);
    end loop;

    for k in 0 to 2 loop
      v.s5(k).before := held(r.s4(k).before);
      v.s5(k).last   := held(r.s4(k).last);
      if r.s4(k).reaches = '0' then
        v.s5(k).before := NEAR_HIGH;
        v.s5(k).last   := NEAR_LOW;
      elsif r.s4(k).open_cut = '1' then
        v.s5(k).before := NEAR_LOW;
        v.s5(k).last   := NEAR_HIGH;
      end if;
    end loop;

    for column in line_mask_t'range loop   -- least and greatest: of any edge
      behind_v := '0';
      up_to_v  := '0';
      for k in 0 to 2 loop
        if r.s5(k).before < column - MIDDLE then
          behind_v := '1';
        end if;
        if r.s5(k).last >= column - MIDDLE then
          up_to_v := '1';
        end if;
      end loop;
      v.columns_s6(column) := behind_v and up_to_v;
    end loop;

    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
    end if;
  end process reg_p;

  columns_o <= r.columns_s6;

end architecture rtl;
