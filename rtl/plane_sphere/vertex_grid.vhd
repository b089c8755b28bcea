-- ============================================================================
-- vertex_grid - where do the vertices of a triangle lie on the pencil's grid?
-- ----------------------------------------------------------------------------
--   @1  reciprocal of the depth's fraction; sums shifted by 0 .. 3; shift and depth checked
--   @2  sums shifted by 0, 4, 8 or 12: factors; do they fit?     dsp_multiply_add, its a and b
--   @3  the point is known, or not                               product
--   @4                                                           its register
--   @5  a slot
-- A vertex' sums over the planes `across` and `down`, divided by its depth, in units of
-- 2^-GRID_FRACTION lines. Each of the three slots keeps its point until the next one for it:
-- points_o are the slots with the vertex given VERTEX_GRID_STAGES clocks ago. A point isn't
-- known if it lies too far from the middle or too near to the eye; its numbers don't count.
-- Two DSP48; the table of reciprocals is 2^DEPTH_FRACTION_BITS words with a read register.
-- model: cmodel/include/raplas/scan_lines.hpp     tests: tb/unit/vertex_grid
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity vertex_grid is
  port (
    clk_i    : in  std_ulogic;
    valid_i  : in  std_ulogic;                      -- a vertex ...
    slot_i   : in  std_ulogic_vector(1 downto 0);   -- ... whose point goes into this slot, 0 .. 2
    across_i : in  std_ulogic_vector(PLANE_SUM_BITS - 1 downto 0);  -- signed: n.v + p of its
    down_i   : in  std_ulogic_vector(PLANE_SUM_BITS - 1 downto 0);  -- plane, LSB 2^-34
    depth_i  : in  depth_t;                         -- depth code, without the margin
    scale_i  : in  std_ulogic_vector(GRID_EXPONENT_BITS - 1 downto 0);
    least_i  : in  std_ulogic_vector(GRID_EXPONENT_BITS - 1 downto 0);
    points_o : out std_ulogic_vector(3 * GRID_POINT_BITS - 1 downto 0)  -- of slots 0, 1, 2:
  );                                                -- known, across, down; VERTEX_GRID_STAGES later
end entity vertex_grid;

architecture rtl of vertex_grid is

  constant F           : natural := DEPTH_FRACTION_BITS;
  constant LEAST_SHIFT : natural := 8;
  constant DROPPED     : natural := 19;             -- bits below a point's units in the products
  constant SUM_BITS    : natural := PLANE_SUM_BITS - LEAST_SHIFT;
  constant FACTOR_BITS : natural := 18;

  subtype factor_t is std_ulogic_vector(FACTOR_BITS - 1 downto 0);
  subtype sum_t is std_ulogic_vector(SUM_BITS - 1 downto 0);

  constant RECIPROCAL : reciprocals_t := reciprocals;
  constant ZERO_48    : std_ulogic_vector(47 downto 0) := (others => '0');

  type s1_t is record
    valid      : std_ulogic;
    slot       : unsigned(1 downto 0);
    deep       : std_ulogic;                        -- depth's exponent isn't below least
    shift      : unsigned(GRID_EXPONENT_BITS downto 2);  -- signed; the rest is done
    reciprocal : reciprocal_t;
    aside      : sum_t;
    down       : sum_t;
  end record;

  type s2_t is record
    valid : std_ulogic;
    slot  : unsigned(1 downto 0);
    known : std_ulogic;                             -- depth and shift permit
    fits  : std_ulogic_vector(0 to 3);              -- of both sums, 4 bits each: sign bits, or kept
  end record;

  type s3_t is record
    valid : std_ulogic;
    slot  : unsigned(1 downto 0);
    known : std_ulogic;
  end record;

  type reg_t is record
    s1     : s1_t;
    s2     : s2_t;
    s3     : s3_t;
    s4     : s3_t;
    points : grid_points_t;
  end record;

  signal r         : reg_t;
  signal rin       : reg_t;
  signal across_s1 : factor_t;
  signal down_s1   : factor_t;
  signal factor_s1 : factor_t;
  signal across_s4 : std_ulogic_vector(47 downto 0);
  signal down_s4   : std_ulogic_vector(47 downto 0);

  -- a sum without its lowest bits, shifted right by 0 .. 3
  function shifted(sum : std_ulogic_vector(PLANE_SUM_BITS - 1 downto 0);
                   low : unsigned(1 downto 0)) return sum_t is
    variable sum_v : sum_t;
  begin
    sum_v := sum(PLANE_SUM_BITS - 1 downto LEAST_SHIFT);
    for k in 1 to 3 loop
      if low = k then
        sum_v := (others => sum(PLANE_SUM_BITS - 1));
        sum_v(SUM_BITS - 1 - k downto 0) := sum(PLANE_SUM_BITS - 1 downto LEAST_SHIFT + k);
      end if;
    end loop;
    return sum_v;
  end function shifted;

  -- a sum's lowest bits after a shift by 0, 4, 8 or 12
  function factor_of(sum : sum_t; high : unsigned(1 downto 0)) return factor_t is
    variable factor_v : factor_t;
  begin
    factor_v := sum(FACTOR_BITS - 1 downto 0);
    for k in 1 to 3 loop
      if high = k then
        factor_v := sum(FACTOR_BITS - 1 + 4 * k downto 4 * k);
      end if;
    end loop;
    return factor_v;
  end function factor_of;

  -- do 4 bits of a sum, from 4 k above a factor's top bit on, all equal the sign?
  function signs_only(sum : sum_t; k : natural) return std_ulogic is
    variable wide_v : signed(FACTOR_BITS + 14 downto 0);
    variable bits_v : signed(3 downto 0);
  begin
    wide_v := resize(signed(sum), FACTOR_BITS + 15);
    bits_v := wide_v(FACTOR_BITS + 2 + 4 * k downto FACTOR_BITS - 1 + 4 * k);
    if (bits_v = 0 and sum(SUM_BITS - 1) = '0') or (bits_v = -1 and sum(SUM_BITS - 1) = '1') then
      return '1';
    end if;
    return '0';
  end function signs_only;

begin

  comb_p : process (r, valid_i, slot_i, across_i, down_i, depth_i, scale_i, least_i, across_s4,
                    down_s4)
    variable v          : reg_t;
    variable exponent_v : unsigned(DEPTH_EXPONENT_BITS - 1 downto 0);
    variable shift_v    : unsigned(GRID_EXPONENT_BITS downto 0);
  begin
    v := r;

    exponent_v := unsigned(depth_i(DEPTH_BITS - 1 downto F));
    shift_v    := resize(exponent_v, GRID_EXPONENT_BITS + 1) - unsigned(scale_i);
    v.s1.valid := valid_i;
    v.s1.slot  := unsigned(slot_i);
    v.s1.deep  := '0';
    if exponent_v >= unsigned(least_i) then
      v.s1.deep := '1';
    end if;
    v.s1.shift      := shift_v(GRID_EXPONENT_BITS downto 2);
    v.s1.reciprocal := RECIPROCAL(to_integer(unsigned(depth_i(F - 1 downto 0))));
    v.s1.aside     := shifted(across_i, shift_v(1 downto 0));
    v.s1.down       := shifted(down_i, shift_v(1 downto 0));

    v.s2.valid := r.s1.valid;
    v.s2.slot  := r.s1.slot;
    v.s2.known := r.s1.deep;
    if r.s1.shift(GRID_EXPONENT_BITS downto 4) /= 0 then
      v.s2.known := '0';
    end if;
    for k in 0 to 3 loop
      v.s2.fits(k) := signs_only(r.s1.aside, k) and signs_only(r.s1.down, k);
      if r.s1.shift(3 downto 2) > k then
        v.s2.fits(k) := '1';
      end if;
    end loop;

    v.s3.valid := r.s2.valid;
    v.s3.slot  := r.s2.slot;
    v.s3.known := r.s2.known and r.s2.fits(0) and r.s2.fits(1) and r.s2.fits(2) and r.s2.fits(3);
    v.s4       := r.s3;

    for k in grid_points_t'range loop
      if r.s4.valid = '1' and r.s4.slot = k then
        v.points(k) := (r.s4.known, across_s4(DROPPED + GRID_BITS - 1 downto DROPPED),
                        down_s4(DROPPED + GRID_BITS - 1 downto DROPPED));
      end if;
    end loop;
    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
    end if;
  end process reg_p;

  across_s1 <= factor_of(r.s1.aside, r.s1.shift(3 downto 2));
  down_s1   <= factor_of(r.s1.down, r.s1.shift(3 downto 2));
  factor_s1 <= std_ulogic_vector(resize(unsigned(r.s1.reciprocal), FACTOR_BITS));

  across_e : entity raplas.dsp_multiply_add
    port map (clk_i => clk_i, a_i => across_s1, b_i => factor_s1, c_i => ZERO_48,
              p_o => across_s4);

  down_e : entity raplas.dsp_multiply_add
    port map (clk_i => clk_i, a_i => down_s1, b_i => factor_s1, c_i => ZERO_48,
              p_o => down_s4);

  points_g : for k in grid_points_t'range generate
    points_o((3 - k) * GRID_POINT_BITS - 1 downto (2 - k) * GRID_POINT_BITS) <=
      r.points(k).known & r.points(k).aside & r.points(k).down;
  end generate points_g;

end architecture rtl;
