-- ============================================================================
-- pencil_control - brings one pencil after the other to the walk
-- ----------------------------------------------------------------------------
-- The host starts banks. The bounds and hit bits of a bank are cleared a clock later;
-- then it waits in a queue for its turn:
--   load:  its planes go into the testers, one of each side a clock, as soon as the
--          walk before has no further object for them
--   walk:  through the tree; then an end-of-pencil token follows the last triangle
-- The next pencil comes while the pairs of this one are still under way. A bank is
-- busy from its start until its token has left the hit queue.
-- model: cmodel/include/raplas/pencil_control.hpp     tests: tb/unit/pencil_control
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity pencil_control is
  port (
    clk_i        : in  std_ulogic;
    rst_i        : in  std_ulogic;
    -- host
    start_i      : in  std_ulogic;                                -- ignored if the bank is busy
    bank_i       : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    busy_o       : out std_ulogic_vector(PENCIL_BANKS - 1 downto 0);   -- a bit for each bank
    clear_o      : out std_ulogic;                                -- bounds and hit bits, please
    clear_bank_o : out std_ulogic_vector(BANK_BITS - 1 downto 0);
    rows_i       : in  std_ulogic_vector(LINE_BITS downto 0);     -- its size, 1 .. 16
    columns_i    : in  std_ulogic_vector(LINE_BITS downto 0);
    -- load
    load_o       : out std_ulogic;                                -- planes of line_o, please
    load_bank_o  : out std_ulogic_vector(BANK_BITS - 1 downto 0);
    line_o       : out std_ulogic_vector(PLANE_INDEX_BITS - 1 downto 0);  -- row and column, 16, 17
    -- walk: the pencil whose turn it is
    bank_o       : out std_ulogic_vector(BANK_BITS - 1 downto 0);
    walk_o       : out std_ulogic;                                -- the walk begins
    walk_spent_i : in  std_ulogic;                                -- no object goes any more
    walk_idle_i  : in  std_ulogic;                                -- and none is under test
    token_o      : out std_ulogic;                                -- behind the last triangle
    token_ready_i : in  std_ulogic;                               -- it is taken in this clock
    -- the end
    done_i       : in  std_ulogic;                                -- a token left the hit queue
    done_bank_i  : in  std_ulogic_vector(BANK_BITS - 1 downto 0)
  );
end entity pencil_control;

architecture rtl of pencil_control is

  constant WAITING_BITS : positive := BANK_BITS + LINE_BITS + 1;

  subtype lines_t is unsigned(LINE_BITS downto 0);

  type reg_t is record
    clear      : std_ulogic;                       -- clear_bank was started
    clear_bank : std_ulogic_vector(BANK_BITS - 1 downto 0);
    loading    : std_ulogic;                       -- a line is asked for in each clock
    loaded     : std_ulogic;                       -- all were, and their walk hasn't begun
    load_bank  : std_ulogic_vector(BANK_BITS - 1 downto 0);
    lines      : lines_t;                          -- of its longer side
    line       : unsigned(PLANE_INDEX_BITS - 1 downto 0);
    walking    : std_ulogic;
    token      : std_ulogic;                       -- wants to go
    bank       : std_ulogic_vector(BANK_BITS - 1 downto 0);
    busy       : std_ulogic_vector(PENCIL_BANKS - 1 downto 0);
  end record;

  signal r           : reg_t;
  signal rin         : reg_t;
  signal waiting_in  : std_ulogic_vector(WAITING_BITS - 1 downto 0);   -- bank, lines
  signal waiting_out : std_ulogic_vector(WAITING_BITS - 1 downto 0);
  signal waiting     : std_ulogic;
  signal take        : std_ulogic;

begin

  queue_i : entity raplas.fifo
    generic map (WIDTH => WAITING_BITS, DEPTH_LOG2 => BANK_BITS)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => r.clear,
      data_i  => waiting_in,
      read_i  => take,
      data_o  => waiting_out,
      valid_o => waiting,
      ready_o => open,
      count_o => open
    );

  comb_p : process (r, start_i, bank_i, rows_i, columns_i, walk_spent_i, walk_idle_i,
                    token_ready_i, done_i, done_bank_i, waiting_out, waiting)
    variable v        : reg_t;
    variable lines_v  : lines_t;
    variable loaded_v : std_ulogic;                -- the last planes are asked for now, or were
  begin
    v := r;

    -- start
    v.clear      := '0';
    v.clear_bank := bank_i;
    for k in v.busy'range loop
      if done_i = '1' and unsigned(done_bank_i) = k then
        v.busy(k) := '0';
      end if;
      if start_i = '1' and unsigned(bank_i) = k and r.busy(k) = '0' then
        v.busy(k) := '1';
        v.clear   := '1';
      end if;
    end loop;

    -- clear
    lines_v := unsigned(rows_i);
    if lines_v < unsigned(columns_i) then
      lines_v := unsigned(columns_i);
    end if;
    waiting_in <= r.clear_bank & std_ulogic_vector(lines_v);

    -- load
    take     <= '0';
    loaded_v := r.loaded;
    if r.loading = '1' then
      v.line := r.line + 1;
      if v.line = r.lines then
        v.line := to_unsigned(AXIS_PLANE, PLANE_INDEX_BITS);
      end if;
      if r.line = GRID_PLANE then
        v.loading := '0';
        loaded_v  := '1';
      end if;
    elsif r.loaded = '0' and waiting = '1' and (r.walking = '0' or walk_spent_i = '1') then
      take        <= '1';
      v.loading   := '1';
      v.load_bank := waiting_out(WAITING_BITS - 1 downto LINE_BITS + 1);
      v.lines     := unsigned(waiting_out(LINE_BITS downto 0));
      v.line      := (others => '0');
    end if;
    v.loaded := loaded_v;

    -- walk
    walk_o <= '0';
    if r.walking = '1' then
      if walk_idle_i = '1' then
        v.walking := '0';
        v.token   := '1';
      end if;
    elsif r.token = '1' then
      if token_ready_i = '1' then
        v.token := '0';
      end if;
    elsif loaded_v = '1' then
      walk_o    <= '1';
      v.walking := '1';
      v.loaded  := '0';
    end if;
    if v.walking = '0' and v.token = '0' then
      v.bank := v.load_bank;
    end if;
    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.clear   <= '0';
        r.loading <= '0';
        r.loaded  <= '0';
        r.walking <= '0';
        r.token   <= '0';
        r.busy    <= (others => '0');
      end if;
    end if;
  end process reg_p;

  busy_o       <= r.busy;
  clear_o      <= r.clear;
  clear_bank_o <= r.clear_bank;
  load_o       <= r.loading;
  load_bank_o  <= r.load_bank;
  line_o       <= std_ulogic_vector(r.line);
  bank_o       <= r.bank;
  token_o      <= r.token;

end architecture rtl;
