-- ============================================================================
-- DSP48 - simulation model of the Virtex-4 multiplier and adder
-- ----------------------------------------------------------------------------
-- Simulation only, library unisim; bound by default binding in GHDL runs.
--
--   P = Z + (X + Y + carry)      SUBTRACT = '0'
--   P = Z - (X + Y + carry)      SUBTRACT = '1'
--
--   OPMODE(1:0)  X: 00 zero, 01 product (with Y = 01 only), 10 P, 11 A:B
--   OPMODE(3:2)  Y: 00 zero, 01 product (with X = 01 only), 11 C
--   OPMODE(6:4)  Z: 000 zero, 001 PCIN, 010 P, 011 C, 101 PCIN >> 17, 110 P >> 17
--   CARRYINSEL   00 CARRYIN, 01 rounds Z (or X = P), 10 rounds the product or A:B,
--                11 the same through a register
--
-- Anything else, and P fed back without its register, gives X. Registers power up
-- at 0. CECINSUB enables the SUBTRACT and CARRYIN registers, CECARRYIN the one of
-- CARRYINSEL = 11; RSTCARRYIN clears both carries, RSTCTRL the other control bits.
-- source: Xilinx UG073, XtremeDSP for Virtex-4 FPGAs, chapter 1
-- tests: tb/sim/dsp48_bench.cpp, against the model that Yosys ships
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity DSP48 is
  generic (  -- see tb/sim/vcomponents.vhd
    AREG          : integer := 1;
    B_INPUT       : string  := "DIRECT";
    BREG          : integer := 1;
    CARRYINREG    : integer := 1;
    CARRYINSELREG : integer := 1;
    CREG          : integer := 1;
    LEGACY_MODE   : string  := "MULT18X18S";
    MREG          : integer := 1;
    OPMODEREG     : integer := 1;
    PREG          : integer := 1;
    SUBTRACTREG   : integer := 1
  );
  port (
    BCOUT      : out std_logic_vector(17 downto 0);  -- B after its registers, to the next slice
    P          : out std_logic_vector(47 downto 0);  -- the result
    PCOUT      : out std_logic_vector(47 downto 0);  -- the same, to the next slice
    A          : in  std_logic_vector(17 downto 0);  -- signed factor
    B          : in  std_logic_vector(17 downto 0);  -- signed factor
    BCIN       : in  std_logic_vector(17 downto 0);  -- the slice before's BCOUT
    C          : in  std_logic_vector(47 downto 0);  -- addend
    CARRYIN    : in  std_ulogic;
    CARRYINSEL : in  std_logic_vector(1 downto 0);
    CEA        : in  std_ulogic;                     -- clock enables
    CEB        : in  std_ulogic;
    CEC        : in  std_ulogic;
    CECARRYIN  : in  std_ulogic;
    CECINSUB   : in  std_ulogic;
    CECTRL     : in  std_ulogic;
    CEM        : in  std_ulogic;
    CEP        : in  std_ulogic;
    CLK        : in  std_ulogic;
    OPMODE     : in  std_logic_vector(6 downto 0);
    PCIN       : in  std_logic_vector(47 downto 0);  -- the slice before's PCOUT
    RSTA       : in  std_ulogic;                     -- synchronous resets
    RSTB       : in  std_ulogic;
    RSTC       : in  std_ulogic;
    RSTCARRYIN : in  std_ulogic;
    RSTCTRL    : in  std_ulogic;
    RSTM       : in  std_ulogic;
    RSTP       : in  std_ulogic;
    SUBTRACT   : in  std_ulogic
  );
end entity DSP48;

architecture sim of DSP48 is

  subtype word18_t is std_logic_vector(17 downto 0);
  subtype word48_t is std_logic_vector(47 downto 0);
  constant UNKNOWN : word48_t := (others => 'X');

  type registers_t is record
    a1, a2, b1, b2 : word18_t;
    c, p           : word48_t;
    m              : std_logic_vector(35 downto 0);
    opmode         : std_logic_vector(6 downto 0);
    carryinsel     : std_logic_vector(1 downto 0);
    subtract       : std_ulogic;
    carryin        : std_ulogic;
    rounding       : std_ulogic;
  end record;
  constant POWER_UP : registers_t := (
    m => (others => '0'), opmode => (others => '0'), carryinsel => (others => '0'),
    subtract => '0', carryin => '0', rounding => '0',
    c | p => (others => '0'), others => (others => '0'));

  -- the register's output or, when the generic says that there is none, its input
  function pick(stages : integer; direct, once, twice : std_logic_vector)
    return std_logic_vector is
  begin
    if stages = 0 then
      return direct;
    elsif stages = 1 then
      return once;
    end if;
    return twice;
  end function pick;

  function pick(stages : integer; direct, once : std_ulogic) return std_ulogic is
  begin
    if stages = 0 then
      return direct;
    end if;
    return once;
  end function pick;

  function extend(value : std_logic_vector) return word48_t is
  begin
    return word48_t(resize(signed(value), 48));
  end function extend;

  function x_mux(mode : std_logic_vector(6 downto 0); m : std_logic_vector; p_in, ab : word48_t)
    return word48_t is
  begin
    if mode(1 downto 0) = "00" and mode(3 downto 2) /= "01" then
      return extend("0");
    elsif mode(3 downto 0) = "0101" then
      return extend(m);  -- both partial products at once: Y then adds nothing
    elsif mode(1 downto 0) = "10" and mode(3 downto 2) /= "01" then
      return p_in;
    elsif mode(1 downto 0) = "11" and mode(3 downto 2) /= "01" then
      return ab;
    end if;
    return UNKNOWN;
  end function x_mux;

  function y_mux(mode : std_logic_vector(6 downto 0); c_in : word48_t) return word48_t is
  begin
    if mode(3 downto 2) = "00" or mode(3 downto 0) = "0101" then
      return extend("0");
    elsif mode(3 downto 2) = "11" then
      return c_in;
    end if;
    return UNKNOWN;
  end function y_mux;

  function z_mux(mode : std_logic_vector(6 downto 0); cascade, p_in, c_in : word48_t)
    return word48_t is
    variable z_v : std_logic_vector(2 downto 0);
  begin
    z_v := mode(6 downto 4);
    if z_v = "000" then
      return extend("0");
    elsif z_v = "001" then
      return cascade;
    elsif z_v = "010" then
      return p_in;
    elsif z_v = "011" then
      return c_in;
    elsif z_v = "101" then
      return extend(cascade(47 downto 17));
    elsif z_v = "110" then
      return extend(p_in(47 downto 17));
    end if;
    return UNKNOWN;
  end function z_mux;

  -- CARRYINSEL = 01: rounds P or PCIN symmetrically
  function round_z(mode : std_logic_vector(6 downto 0); cascade_sign, p_sign : std_ulogic)
    return std_ulogic is
    variable z_v : std_logic_vector(2 downto 0);
  begin
    z_v := mode(6 downto 4);
    if mode(1 downto 0) = "10" or z_v = "010" or z_v = "110" then
      return not p_sign;
    elsif z_v = "001" or z_v = "101" then
      return not cascade_sign;
    end if;
    return 'X';
  end function round_z;

  -- CARRYINSEL = 10 and 11: rounds A:B, or the product before its register
  function round_xy(mode : std_logic_vector(6 downto 0); a_sign, b_sign : std_ulogic)
    return std_ulogic is
  begin
    if mode(1 downto 0) = "11" then
      return not a_sign;
    end if;
    return a_sign xnor b_sign;
  end function round_xy;

  function carry(source : std_logic_vector(1 downto 0); pin, z, xy, xy_registered : std_ulogic)
    return std_ulogic is
  begin
    if source = "00" then
      return pin;
    elsif source = "01" then
      return z;
    elsif source = "10" then
      return xy;
    elsif source = "11" then
      return xy_registered;
    end if;
    return 'X';
  end function carry;

  -- product by pieces that fit an integer: many times faster than numeric_std's "*"
  function multiply(a_in, b_in : word18_t) return std_logic_vector is
    constant HALF   : integer := 512;
    variable low_v  : integer;
    variable high_v : integer;
    variable m_v    : std_logic_vector(35 downto 0);
  begin
    m_v := (others => 'X');
    if not is_x(a_in) and not is_x(b_in) then
      low_v  := to_integer(signed(a_in)) * to_integer(unsigned(b_in(8 downto 0)));
      high_v := to_integer(signed(a_in)) * to_integer(signed(b_in(17 downto 9)));
      m_v(8 downto 0)  := std_logic_vector(to_unsigned(low_v mod HALF, 9));
      m_v(35 downto 9) := std_logic_vector(to_signed(high_v + (low_v - low_v mod HALF) / HALF, 27));
    end if;
    return m_v;
  end function multiply;

  -- z + (x + y + carry) or z - (x + y + carry), also by pieces
  function add(z, x, y : word48_t; carry_in, minus : std_ulogic) return word48_t is
    constant HALF   : integer := 2 ** 24;
    variable term_v : integer;
    variable sum_v  : integer;
    variable p_v    : word48_t;
  begin
    if is_x(z) or is_x(x) or is_x(y) or is_x(carry_in) or is_x(minus) then
      return UNKNOWN;
    end if;
    sum_v := 0;
    for k in 0 to 1 loop
      term_v := to_integer(unsigned(x(24 * k + 23 downto 24 * k)))
                + to_integer(unsigned(y(24 * k + 23 downto 24 * k)));
      if k = 0 and carry_in = '1' then
        term_v := term_v + 1;
      end if;
      if minus = '1' then
        term_v := -term_v;
      end if;
      sum_v := sum_v + to_integer(unsigned(z(24 * k + 23 downto 24 * k))) + term_v;
      p_v(24 * k + 23 downto 24 * k) := std_logic_vector(to_unsigned(sum_v mod HALF, 24));
      sum_v := (sum_v - sum_v mod HALF) / HALF;
    end loop;
    return p_v;
  end function add;

  signal r        : registers_t := POWER_UP;
  signal b_direct : word18_t;  -- the B input or BCIN
  signal a_used   : word18_t;  -- A, B, C and the control bits after their registers
  signal b_used   : word18_t;
  signal c_used   : word48_t;
  signal op       : std_logic_vector(6 downto 0);
  signal source   : std_logic_vector(1 downto 0);
  signal minus    : std_ulogic;
  signal carry_0  : std_ulogic;
  signal rounding : std_ulogic;
  signal p_now    : word48_t;

  -- P's register input; a function of everything, called only when it is needed
  function result(mode : std_logic_vector(6 downto 0); a_in, b_in : word18_t;
                  c_in, cascade, p_in : word48_t; m_register : std_logic_vector(35 downto 0);
                  sel : std_logic_vector(1 downto 0); sub, pin, xy, xy_registered : std_ulogic)
    return word48_t is
    variable m_v : std_logic_vector(35 downto 0);
    variable p_v : word48_t;  -- P as the multiplexers see it
  begin
    m_v := m_register;
    if MREG = 0 and mode(3 downto 0) = "0101" then
      m_v := multiply(a_in, b_in);
    end if;
    p_v := pick(PREG, UNKNOWN, p_in, p_in);
    return add(z_mux(mode, cascade, p_v, c_in), x_mux(mode, m_v, p_v, extend(a_in & b_in)),
               y_mux(mode, c_in),
               carry(sel, pin, round_z(mode, cascade(47), p_v(47)), xy, xy_registered), sub);
  end function result;

begin

  cascade_g : if B_INPUT = "CASCADE" generate
    b_direct <= BCIN;
  end generate cascade_g;
  direct_g : if B_INPUT /= "CASCADE" generate
    b_direct <= B;
  end generate direct_g;

  a_used   <= pick(AREG, A, r.a1, r.a2);
  b_used   <= pick(BREG, b_direct, r.b1, r.b2);
  c_used   <= pick(CREG, C, r.c, r.c);
  op       <= pick(OPMODEREG, OPMODE, r.opmode, r.opmode);
  source   <= pick(CARRYINSELREG, CARRYINSEL, r.carryinsel, r.carryinsel);
  minus    <= pick(SUBTRACTREG, SUBTRACT, r.subtract);
  carry_0  <= pick(CARRYINREG, CARRYIN, r.carryin);
  rounding <= round_xy(op, a_used(17), b_used(17));

  registered_g : if PREG /= 0 generate
    p_now <= r.p;
  end generate registered_g;
  combinational_g : if PREG = 0 generate
    p_now <= result(op, a_used, b_used, c_used, PCIN, r.p, r.m, source, minus, carry_0, rounding,
                    r.rounding);
  end generate combinational_g;
  BCOUT <= b_used;
  P     <= p_now;
  PCOUT <= p_now;

  regs : process (CLK)
  begin
    if rising_edge(CLK) then
      if CEA = '1' then r.a1 <= A; r.a2 <= r.a1; end if;
      if CEB = '1' then r.b1 <= b_direct; r.b2 <= r.b1; end if;
      if CEC = '1' then r.c <= C; end if;
      if CECTRL = '1' then r.opmode <= OPMODE; r.carryinsel <= CARRYINSEL; end if;
      if CECINSUB = '1' then r.subtract <= SUBTRACT; r.carryin <= CARRYIN; end if;
      if CECARRYIN = '1' then r.rounding <= rounding; end if;
      if CEM = '1' and MREG /= 0 then r.m <= multiply(a_used, b_used); end if;
      if CEP = '1' and PREG /= 0 then
        r.p <= result(op, a_used, b_used, c_used, PCIN, r.p, r.m, source, minus, carry_0, rounding,
                      r.rounding);
      end if;

      if RSTA = '1' then r.a1 <= (others => '0'); r.a2 <= (others => '0'); end if;
      if RSTB = '1' then r.b1 <= (others => '0'); r.b2 <= (others => '0'); end if;
      if RSTC = '1' then r.c <= (others => '0'); end if;
      if RSTM = '1' then r.m <= (others => '0'); end if;
      if RSTP = '1' then r.p <= (others => '0'); end if;
      if RSTCTRL = '1' then
        r.opmode <= (others => '0'); r.carryinsel <= (others => '0'); r.subtract <= '0';
      end if;
      if RSTCARRYIN = '1' then r.carryin <= '0'; r.rounding <= '0'; end if;
    end if;
  end process regs;

end architecture sim;
