-- ============================================================================
-- edge_cut - the line through an edge: where it cuts the rows of the grid
-- ----------------------------------------------------------------------------
--   @1  the points' difference; which coordinates are small
--   @2  the upper point first; bits of the error
--   @3  top group of 4 bits of the rows between; rows grown by the error
--   @4  top bit in the group, fraction below it
--   @5  reciprocal; first and last row
--   @8  columns between, times the reciprocal              dsp_multiply_add
--   @9  slope
--   @10 |slope|; does it fit
--   @11 1 + |slope|
--   @12 times the error; column on the middle line         dsp_multiply_add
--   @13 margin; does the column fit                        EDGE_SETUP_STAGES
-- A new edge each clock. Two DSP48, one block RAM.
-- model: cmodel/include/raplas/scan_lines.hpp     tests: tb/unit/edge_setup
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity edge_cut is
  port (
    clk_i   : in  std_ulogic;
    a_i     : in  grid_place_t;                                     -- its ends ...
    b_i     : in  grid_place_t;
    error_i : in  std_ulogic_vector(GRID_ERROR_BITS - 1 downto 0);  -- ... and of its limits
    cut_o   : out edge_cut_word_t                                   -- EDGE_SETUP_STAGES later
  );
end entity edge_cut;

architecture rtl of edge_cut is

  constant NEAR_BITS   : positive := 11;    -- the error is larger if a coordinate has more, ...
  constant MIDDLE_BITS : positive := 13;    -- ... and again
  constant LEAST_ERROR : natural  := 2;     -- bits of the least error

  -- stages
  constant SLOPE_STAGE : positive := 5 + MULTIPLY_ADD_STAGES + 1;
  constant AT_STAGE    : positive := SLOPE_STAGE + MULTIPLY_ADD_STAGES;

  constant F            : natural := DEPTH_FRACTION_BITS;       -- of a reciprocal's index
  constant PRODUCT_BITS : natural := GRID_BITS + RECIPROCAL_BITS + 1;
  constant SLOPE_LSB    : natural := RECIPROCAL_BITS - SLOPE_FRACTION;   -- of a product, top = 0
  constant AT_LSB       : natural := SLOPE_FRACTION + GRID_FRACTION - CUT_FRACTION;
  constant AT_SUM_BITS  : natural := GRID_BITS + SLOPE_BITS;
  constant TOP_BITS     : natural := 4;                         -- of the number of a bit of height
  constant ERROR_BITS   : natural := 4;
  constant LINE_LSB     : natural := GRID_FRACTION;
  constant MIDDLE_LINE  : natural := NUM_LINES / 2;
  constant ROUNDINGS    : natural := 2;                         -- added to the margin


  subtype coordinate_t is signed(GRID_BITS - 1 downto 0);
  subtype difference_t is signed(GRID_BITS downto 0);
  subtype line_number_t is signed(GRID_BITS - LINE_LSB downto 0);
  subtype cut_line_t is signed(CUT_LINE_BITS - 1 downto 0);


  constant RECIPROCAL : reciprocals_t := reciprocals;

  -- it has at most `bits` bits: those from the sign upward are equal
  function fits(value : signed; bits : positive) return std_ulogic is
    variable fits_v : std_ulogic;
  begin
    fits_v := '1';
    for k in bits to value'high loop
      if value(k) /= value(bits - 1) then
        fits_v := '0';
      end if;
    end loop;
    return fits_v;
  end function fits;

  -- -value if negative = '1'
  function negated(value : signed; negative : std_ulogic) return signed is
    variable value_v : signed(value'high downto 0);
  begin
    value_v := value;
    if negative = '1' then
      value_v := -value;
    end if;
    return value_v;
  end function negated;

  type s1_t is record
    a_across : coordinate_t;
    a_down   : coordinate_t;
    b_across : coordinate_t;
    b_down   : coordinate_t;
    width    : difference_t;                                -- b - a, across
    height   : difference_t;                                -- down
    near     : std_ulogic_vector(0 to 3);                   -- for each coordinate
    middle   : std_ulogic_vector(0 to 3);
    error    : unsigned(GRID_ERROR_BITS - 1 downto 0);
  end record;
  type s2_t is record                                       -- b is not above a
    a_across   : coordinate_t;
    a_down     : coordinate_t;
    b_down     : coordinate_t;
    width      : difference_t;
    height     : unsigned(GRID_BITS - 1 downto 0);
    error_log2 : unsigned(ERROR_BITS - 1 downto 0);
  end record;
  type s3_t is record
    flat       : std_ulogic;                                -- height is 0
    group_no   : unsigned(1 downto 0);
    window     : std_ulogic_vector(F + 3 downto 0);         -- the group, and F bits below
    minus_down : difference_t;                              -- of a
    before     : difference_t;                              -- from a grown to the middle line
    behind     : difference_t;                              -- from the middle line to b grown
  end record;
  type s4_t is record
    index       : std_ulogic_vector(F - 1 downto 0);
    top         : std_ulogic_vector(TOP_BITS - 1 downto 0);
    before      : line_number_t;
    behind      : line_number_t;
    before_fits : std_ulogic;                               -- -MIDDLE_LINE .. MIDDLE_LINE - 1
    behind_fits : std_ulogic;
  end record;
  type s5_t is record
    reciprocal : reciprocal_t;
    first      : cut_line_t;
    last       : cut_line_t;
  end record;
  type s9_t is record
    slope : signed(PRODUCT_BITS - SLOPE_LSB - 1 downto 0);
  end record;
  type s10_t is record
    slope     : signed(SLOPE_BITS - 1 downto 0);
    fits      : std_ulogic;
    magnitude : unsigned(SLOPE_BITS - 1 downto 0);
  end record;
  type s11_t is record
    slope  : signed(SLOPE_BITS - 1 downto 0);
    fits   : std_ulogic;
    factor : unsigned(SLOPE_BITS - 1 downto 0);             -- 1 + |slope|
    shift  : unsigned(ERROR_BITS - 2 downto 0);
  end record;
  type s12_t is record
    slope  : signed(SLOPE_BITS - 1 downto 0);
    fits   : std_ulogic;
    margin : unsigned(MARGIN_BITS - 1 downto 0);
  end record;

  type reg_t is record
    s1  : s1_t;
    s2  : s2_t;
    s3  : s3_t;
    s4  : s4_t;
    s5  : s5_t;
    s9  : s9_t;
    s10 : s10_t;
    s11 : s11_t;
    s12 : s12_t;
    cut : edge_cut_word_t;
  end record;

  signal r   : reg_t;
  signal rin : reg_t;

  signal width_s2     : std_ulogic_vector(GRID_BITS downto 0);
  signal width_s5     : std_ulogic_vector(GRID_BITS downto 0);
  signal a_across_s2   : std_ulogic_vector(GRID_BITS - 1 downto 0);
  signal a_across_s10  : std_ulogic_vector(GRID_BITS - 1 downto 0);
  signal error_log2_s2 : std_ulogic_vector(ERROR_BITS - 1 downto 0);
  signal error_s10     : std_ulogic_vector(ERROR_BITS - 1 downto 0);
  signal minus_down_s3 : std_ulogic_vector(GRID_BITS downto 0);
  signal minus_down_s9 : std_ulogic_vector(GRID_BITS downto 0);
  signal flat_s3       : std_ulogic_vector(0 downto 0);
  signal flat_s12      : std_ulogic_vector(0 downto 0);
  signal top_s8        : std_ulogic_vector(TOP_BITS - 1 downto 0);
  signal lines_s5      : std_ulogic_vector(2 * CUT_LINE_BITS - 1 downto 0);
  signal lines_s12     : std_ulogic_vector(2 * CUT_LINE_BITS - 1 downto 0);

  signal zero        : std_ulogic_vector(47 downto 0);
  signal width_18    : std_ulogic_vector(17 downto 0);
  signal recip_18    : std_ulogic_vector(17 downto 0);
  signal product_s8  : std_ulogic_vector(47 downto 0);
  signal slope_18    : std_ulogic_vector(17 downto 0);
  signal down_18     : std_ulogic_vector(17 downto 0);
  signal a_across_48 : std_ulogic_vector(47 downto 0);
  signal at_s12      : std_ulogic_vector(47 downto 0);

begin

  ends_p : process (a_i, b_i, error_i)
    variable v    : s1_t;
    variable aa_v : coordinate_t;
    variable ad_v : coordinate_t;
    variable ba_v : coordinate_t;
    variable bd_v : coordinate_t;
  begin
    aa_v := signed(a_i(2 * GRID_BITS - 1 downto GRID_BITS));
    ad_v := signed(a_i(GRID_BITS - 1 downto 0));
    ba_v := signed(b_i(2 * GRID_BITS - 1 downto GRID_BITS));
    bd_v := signed(b_i(GRID_BITS - 1 downto 0));
    v.a_across := aa_v;
    v.a_down   := ad_v;
    v.b_across := ba_v;
    v.b_down   := bd_v;
    v.width    := resize(ba_v, GRID_BITS + 1) - resize(aa_v, GRID_BITS + 1);
    v.height   := resize(bd_v, GRID_BITS + 1) - resize(ad_v, GRID_BITS + 1);
    v.near     := fits(aa_v, NEAR_BITS) & fits(ad_v, NEAR_BITS)
                  & fits(ba_v, NEAR_BITS) & fits(bd_v, NEAR_BITS);
    v.middle   := fits(aa_v, MIDDLE_BITS) & fits(ad_v, MIDDLE_BITS)
                  & fits(ba_v, MIDDLE_BITS) & fits(bd_v, MIDDLE_BITS);
    v.error    := unsigned(error_i);
    rin.s1     <= v;
  end process ends_p;

  order_p : process (r.s1)
    variable v      : s2_t;
    variable swap_v : std_ulogic;
  begin
    swap_v     := r.s1.height(GRID_BITS);
    v.a_across := r.s1.a_across;
    v.a_down   := r.s1.a_down;
    v.b_down   := r.s1.b_down;
    if swap_v = '1' then
      v.a_across := r.s1.b_across;
      v.a_down   := r.s1.b_down;
      v.b_down   := r.s1.a_down;
    end if;
    v.width      := negated(r.s1.width, swap_v);
    v.height     := resize(unsigned(negated(r.s1.height, swap_v)), GRID_BITS);
    v.error_log2 := resize(r.s1.error, ERROR_BITS) + LEAST_ERROR;
    if r.s1.middle /= "1111" then
      v.error_log2 := resize(r.s1.error, ERROR_BITS) + (LEAST_ERROR + 4);
    elsif r.s1.near /= "1111" then
      v.error_log2 := resize(r.s1.error, ERROR_BITS) + (LEAST_ERROR + 2);
    end if;
    rin.s2 <= v;
  end process order_p;

  group_p : process (r.s2)
    variable v        : s3_t;
    variable error_v  : difference_t;
    variable padded_v : std_ulogic_vector(GRID_BITS + F - 1 downto 0);
  begin
    padded_v := (others => '0');
    padded_v(padded_v'high downto F) := std_ulogic_vector(r.s2.height);
    v.flat     := '1';
    v.group_no := "00";
    v.window   := padded_v(F + 3 downto 0);
    for g in 0 to GRID_BITS / 4 - 1 loop
      if unsigned(padded_v(F + 4 * g + 3 downto F + 4 * g)) /= 0 then
        v.flat     := '0';
        v.group_no := to_unsigned(g, 2);
        v.window   := padded_v(F + 4 * g + 3 downto 4 * g);
      end if;
    end loop;
    error_v := (others => '0');
    for k in LEAST_ERROR to LEAST_ERROR + 2 ** GRID_ERROR_BITS + 3 loop
      if r.s2.error_log2 = k then
        error_v(k) := '1';
      end if;
    end loop;
    v.minus_down := -resize(r.s2.a_down, GRID_BITS + 1);
    v.before     := error_v - resize(r.s2.a_down, GRID_BITS + 1);
    v.behind     := error_v + resize(r.s2.b_down, GRID_BITS + 1);
    rin.s3       <= v;
  end process group_p;

  top_p : process (r.s3)
    variable v        : s4_t;
    variable bit_v    : unsigned(1 downto 0);
    variable before_v : line_number_t;
    variable behind_v : line_number_t;
  begin
    bit_v   := "00";
    v.index := r.s3.window(F - 1 downto 0);
    for k in 1 to 3 loop
      if r.s3.window(F + k) = '1' then
        bit_v   := to_unsigned(k, 2);
        v.index := r.s3.window(F + k - 1 downto k);
      end if;
    end loop;
    v.top         := std_ulogic_vector(r.s3.group_no & bit_v);
    before_v      := r.s3.before(GRID_BITS downto LINE_LSB);
    behind_v      := r.s3.behind(GRID_BITS downto LINE_LSB);
    v.before      := before_v;
    v.behind      := behind_v;
    v.before_fits := fits(before_v, LINE_BITS);
    v.behind_fits := fits(behind_v, LINE_BITS);
    rin.s4        <= v;
  end process top_p;

  lines_p : process (r.s4)
    variable before_v : cut_line_t;
    variable behind_v : cut_line_t;
  begin
    before_v := resize(r.s4.before(LINE_BITS - 1 downto 0), CUT_LINE_BITS);
    if r.s4.before_fits = '0' then
      before_v := to_signed(MIDDLE_LINE, CUT_LINE_BITS);
      if r.s4.before(line_number_t'high) = '1' then
        before_v := to_signed(-MIDDLE_LINE, CUT_LINE_BITS);
      end if;
    end if;
    behind_v := resize(r.s4.behind(LINE_BITS - 1 downto 0), CUT_LINE_BITS);
    if r.s4.behind_fits = '0' then
      behind_v := to_signed(MIDDLE_LINE - 1, CUT_LINE_BITS);
      if r.s4.behind(line_number_t'high) = '1' then
        behind_v := to_signed(-MIDDLE_LINE - 1, CUT_LINE_BITS);
      end if;
    end if;
    rin.s5.first <= -before_v;
    rin.s5.last  <= behind_v;
  end process lines_p;

  rin.s5.reciprocal <= RECIPROCAL(to_integer(unsigned(r.s4.index)));

  -- products
  zero      <= (others => '0');
  width_18  <= std_ulogic_vector(resize(signed(width_s5), 18));
  recip_18  <= std_ulogic_vector(resize(unsigned(r.s5.reciprocal), 18));

  slope_i : entity raplas.dsp_multiply_add
    port map (clk_i => clk_i, a_i => width_18, b_i => recip_18, c_i => zero, p_o => product_s8);

  slope_18    <= std_ulogic_vector(r.s9.slope(17 downto 0));
  down_18     <= std_ulogic_vector(resize(signed(minus_down_s9), 18));
  a_across_48 <= std_ulogic_vector(shift_left(resize(signed(a_across_s10), 48), SLOPE_FRACTION));

  at_i : entity raplas.dsp_multiply_add
    port map (clk_i => clk_i, a_i => slope_18, b_i => down_18, c_i => a_across_48, p_o => at_s12);

  slope_p : process (r.s9, r.s10, r.s11, product_s8, top_s8, error_s10)
    variable product_v   : signed(PRODUCT_BITS - SLOPE_LSB - 1 downto 0);
    variable magnitude_v : signed(SLOPE_BITS - 1 downto 0);
    variable shift_v     : unsigned(ERROR_BITS - 1 downto 0);
  begin
    product_v := signed(product_s8(PRODUCT_BITS - 1 downto SLOPE_LSB));
    for k in top_s8'range loop   -- no shift_right: GHDL exports it without the sign
      if top_s8(k) = '1' then
        product_v := resize(product_v(product_v'high downto 2 ** k), product_v'length);
      end if;
    end loop;
    rin.s9.slope <= product_v;

    magnitude_v       := r.s9.slope(SLOPE_BITS - 1 downto 0);
    magnitude_v       := negated(magnitude_v, magnitude_v(SLOPE_BITS - 1));
    rin.s10.slope     <= r.s9.slope(SLOPE_BITS - 1 downto 0);
    rin.s10.fits      <= fits(r.s9.slope, SLOPE_BITS);
    rin.s10.magnitude <= unsigned(magnitude_v);

    shift_v        := (AT_LSB - 1) - unsigned(error_s10);
    rin.s11.slope  <= r.s10.slope;
    rin.s11.fits   <= r.s10.fits;
    rin.s11.factor <= r.s10.magnitude + 2 ** SLOPE_FRACTION;
    rin.s11.shift  <= shift_v(ERROR_BITS - 2 downto 0);

    rin.s12.slope  <= r.s11.slope;
    rin.s12.fits   <= r.s11.fits;
    rin.s12.margin <= shift_right(r.s11.factor(SLOPE_BITS - 1 downto 1), to_integer(r.s11.shift));
  end process slope_p;

  cut_p : process (r.s12, at_s12, flat_s12, lines_s12)
    variable open_v   : std_ulogic;
    variable at_v     : signed(AT_SUM_BITS - AT_LSB - 1 downto 0);
    variable number_v : std_ulogic_vector(CUT_BITS + SLOPE_BITS + MARGIN_BITS - 1 downto 0);
  begin
    at_v     := signed(at_s12(AT_SUM_BITS - 1 downto AT_LSB));
    open_v   := flat_s12(0) or not r.s12.fits or not fits(at_v, CUT_BITS);
    number_v := std_ulogic_vector(at_v(CUT_BITS - 1 downto 0)) & std_ulogic_vector(r.s12.slope)
                & std_ulogic_vector(r.s12.margin + ROUNDINGS);
    if open_v = '1' then
      number_v := (others => '0');
    end if;
    rin.cut <= open_v & lines_s12 & number_v;
  end process cut_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
    end if;
  end process reg_p;

  cut_o <= r.cut;

  -- beside the pipeline
  width_s2      <= std_ulogic_vector(r.s2.width);
  a_across_s2   <= std_ulogic_vector(r.s2.a_across);
  error_log2_s2 <= std_ulogic_vector(r.s2.error_log2);
  minus_down_s3 <= std_ulogic_vector(r.s3.minus_down);
  flat_s3(0)    <= r.s3.flat;
  lines_s5      <= std_ulogic_vector(r.s5.first) & std_ulogic_vector(r.s5.last);

  width_i : entity raplas.delay
    generic map (WIDTH => GRID_BITS + 1, STAGES => 5 - 2)
    port map (clk_i => clk_i, rst_i => '0', data_i => width_s2, data_o => width_s5);
  a_across_i : entity raplas.delay
    generic map (WIDTH => GRID_BITS, STAGES => SLOPE_STAGE + 1 - 2)
    port map (clk_i => clk_i, rst_i => '0', data_i => a_across_s2, data_o => a_across_s10);
  error_i_i : entity raplas.delay
    generic map (WIDTH => ERROR_BITS, STAGES => SLOPE_STAGE + 1 - 2)
    port map (clk_i => clk_i, rst_i => '0', data_i => error_log2_s2, data_o => error_s10);
  minus_down_i : entity raplas.delay
    generic map (WIDTH => GRID_BITS + 1, STAGES => SLOPE_STAGE - 3)
    port map (clk_i => clk_i, rst_i => '0', data_i => minus_down_s3, data_o => minus_down_s9);
  flat_i : entity raplas.delay
    generic map (STAGES => AT_STAGE - 3)
    port map (clk_i => clk_i, rst_i => '0', data_i => flat_s3, data_o => flat_s12);
  top_i : entity raplas.delay
    generic map (WIDTH => TOP_BITS, STAGES => SLOPE_STAGE - 1 - 4)
    port map (clk_i => clk_i, rst_i => '0', data_i => r.s4.top, data_o => top_s8);
  lines_i : entity raplas.delay
    generic map (WIDTH => 2 * CUT_LINE_BITS, STAGES => AT_STAGE - 5)
    port map (clk_i => clk_i, rst_i => '0', data_i => lines_s5, data_o => lines_s12);

end architecture rtl;
