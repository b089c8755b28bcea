-- ============================================================================
-- pencil_control - brings one pencil after the other to the walk
-- ----------------------------------------------------------------------------
-- The host starts banks; each waits in a queue for its turn: its planes go into
-- the testers, one of each side a clock, while the bounds and hit bits of its rays
-- are cleared; the tree is walked; an end-of-pencil token follows the last triangle.
-- The next pencil comes while the pairs of this one are still under way. A bank
-- is busy from its start until its token has left the hit queue.
-- model: cmodel/include/raplas/pencil_control.hpp     tests: tb/unit/pencil_control
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity pencil_control is
  port (
    clk_i       : in  std_ulogic;
    rst_i       : in  std_ulogic;
    -- host
    start_i     : in  std_ulogic;                                 -- ignored if the bank is busy
    bank_i      : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    busy_o      : out std_ulogic_vector(PENCIL_BANKS - 1 downto 0);   -- a bit for each bank
    -- the pencil whose turn it is
    bank_o      : out std_ulogic_vector(BANK_BITS - 1 downto 0);
    rows_i      : in  std_ulogic_vector(LINE_BITS downto 0);      -- its size, 1 .. 16
    columns_i   : in  std_ulogic_vector(LINE_BITS downto 0);
    clear_o     : out std_ulogic;                                 -- bounds and hit bits, please
    clearing_i  : in  std_ulogic;                                 -- from the next clock on
    load_o      : out std_ulogic;                                 -- planes of line_o, please
    line_o      : out std_ulogic_vector(PLANE_INDEX_BITS - 1 downto 0);  -- row and column, 16, 17
    walk_o      : out std_ulogic;                                 -- the walk begins
    walk_idle_i : in  std_ulogic;
    token_o     : out std_ulogic;                                 -- behind the last triangle
    token_ready_i : in  std_ulogic;                               -- it is taken in this clock
    -- the end
    done_i      : in  std_ulogic;                                 -- a token left the hit queue
    done_bank_i : in  std_ulogic_vector(BANK_BITS - 1 downto 0)
  );
end entity pencil_control;

architecture rtl of pencil_control is

  type reg_t is record
    loading  : std_ulogic;                       -- a line is asked for in each clock
    clear    : std_ulogic;                       -- the first clock of loading
    settling : std_ulogic;                       -- planes are there, bounds are not yet clear
    walking  : std_ulogic;
    token    : std_ulogic;                       -- wants to go
    line     : unsigned(PLANE_INDEX_BITS - 1 downto 0);
    bank     : std_ulogic_vector(BANK_BITS - 1 downto 0);
    busy     : std_ulogic_vector(PENCIL_BANKS - 1 downto 0);
  end record;

  signal r     : reg_t;
  signal rin   : reg_t;
  signal start : std_ulogic;                     -- of a bank that isn't busy
  signal next_bank : std_ulogic_vector(BANK_BITS - 1 downto 0);
  signal waiting   : std_ulogic;
  signal take      : std_ulogic;

begin

  queue_i : entity raplas.fifo
    generic map (WIDTH => BANK_BITS, DEPTH_LOG2 => BANK_BITS)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => start,
      data_i  => bank_i,
      read_i  => take,
      data_o  => next_bank,
      valid_o => waiting,
      ready_o => open,
      count_o => open
    );

  comb_p : process (r, start_i, bank_i, rows_i, columns_i, clearing_i, walk_idle_i, token_ready_i,
                    done_i, done_bank_i, next_bank, waiting)
    variable v       : reg_t;
    variable lines_v : unsigned(LINE_BITS downto 0);   -- of the longer side
    variable take_v  : std_ulogic;
  begin
    v       := r;
    v.clear := '0';
    walk_o  <= '0';
    take_v  := '0';
    start   <= '0';

    lines_v := unsigned(rows_i);
    if lines_v < unsigned(columns_i) then
      lines_v := unsigned(columns_i);
    end if;
    if r.loading = '1' then
      v.line := r.line + 1;
      if v.line = lines_v then
        v.line := to_unsigned(AXIS_PLANE, PLANE_INDEX_BITS);
      end if;
      if r.line = GRID_PLANE then
        v.loading  := '0';
        v.settling := '1';
      end if;
    elsif r.settling = '1' then
      if clearing_i = '0' then
        v.settling := '0';
        v.walking  := '1';
        walk_o     <= '1';
      end if;
    elsif r.walking = '1' then
      if walk_idle_i = '1' then
        v.walking := '0';
        v.token   := '1';
      end if;
    elsif r.token = '1' then
      if token_ready_i = '1' then
        v.token := '0';
      end if;
    elsif waiting = '1' then
      take_v    := '1';
      v.bank    := next_bank;
      v.loading := '1';
      v.clear   := '1';
      v.line    := (others => '0');
    end if;

    for k in v.busy'range loop
      if done_i = '1' and unsigned(done_bank_i) = k then
        v.busy(k) := '0';
      end if;
      if start_i = '1' and unsigned(bank_i) = k and r.busy(k) = '0' then
        v.busy(k) := '1';
        start     <= '1';
      end if;
    end loop;

    take <= take_v;
    rin  <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.loading  <= '0';
        r.clear    <= '0';
        r.settling <= '0';
        r.walking  <= '0';
        r.token    <= '0';
        r.busy     <= (others => '0');
      end if;
    end if;
  end process reg_p;

  busy_o  <= r.busy;
  bank_o  <= r.bank;
  clear_o <= r.clear;
  load_o  <= r.loading;
  line_o  <= std_ulogic_vector(r.line);
  token_o <= r.token;

end architecture rtl;
