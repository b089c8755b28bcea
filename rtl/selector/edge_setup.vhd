-- ============================================================================
-- edge_setup - triangles that may still matter, with their edges, an edge a clock
-- ----------------------------------------------------------------------------
--   @0  an edge of the front word
--   @13 its cut                                            edge_cut
-- The word is taken with its last edge, and its cuts are the last three edges'.
-- A triangle whose rows are all hidden is dropped; one with an unknown point, and
-- the end of a pencil, are taken at once, and their cuts don't count. A triangle
-- begins only if the queue has room for it behind all that can be under way.
-- model: cmodel/include/raplas/edge_setup.hpp     tests: tb/unit/edge_setup
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity edge_setup is
  port (
    clk_i        : in  std_ulogic;
    rst_i        : in  std_ulogic;
    valid_i      : in  std_ulogic;                 -- front of the queue of triangles
    word_i       : in  queued_triangle_word_t;
    ready_o      : out std_ulogic;                 -- it is taken in this clock
    pair_bank_o  : out bank_t;                     -- of the word at the front ...
    row_bounds_i : in  line_bounds_t;              -- ... its row bounds, in the same clock
    error_i      : in  std_ulogic_vector(GRID_ERROR_BITS - 1 downto 0);   -- ... and of its limits
    valid_o      : out std_ulogic;                 -- into the queue of cut triangles
    word_o       : out cut_triangle_word_t;
    count_i      : in  std_ulogic_vector(CUT_FIFO_DEPTH_LOG2 downto 0)    -- words in it
  );
end entity edge_setup;

architecture rtl of edge_setup is

  constant NO_LINES : line_mask_t := (others => '0');
  constant HEAD_LSB : natural     := 3 * EDGE_CUT_BITS;     -- of what isn't cuts in a word

  subtype head_t is std_ulogic_vector(CUT_TRIANGLE_BITS - HEAD_LSB - 1 downto 0);

  signal edge_no      : unsigned(1 downto 0);               -- of the word at the front
  signal next_edge_no : unsigned(1 downto 0);
  signal front        : queued_triangle_t;
  signal goes         : std_ulogic;                         -- a word is taken and not dropped
  signal head         : head_t;                             -- it, without cuts
  signal head_end     : head_t;
  signal a, b         : grid_place_t;
  signal cut          : edge_cut_word_t;                    -- @13
  signal cut_before   : edge_cut_word_t;                    -- of the clock before
  signal cut_first    : edge_cut_word_t;                    -- and of the one before

begin

  front       <= unpack_queued_triangle(word_i);
  pair_bank_o <= front.bank;

  -- which edge, and what becomes of the word
  take_p : process (edge_no, valid_i, front, row_bounds_i, count_i)
    variable rows_v  : line_mask_t;
    variable known_v : std_ulogic;
  begin
    rows_v  := front.rows and lines_beyond(front.z, row_bounds_i);
    known_v := front.points(0).known and front.points(1).known and front.points(2).known;

    ready_o      <= '0';
    goes         <= '0';
    next_edge_no <= "00";
    if edge_no = 2 then
      ready_o <= '1';
      goes    <= '1';
    elsif edge_no = 1 then
      next_edge_no <= "10";
    elsif valid_i = '1' and unsigned(count_i) < 2 ** CUT_FIFO_DEPTH_LOG2 - EDGE_SETUP_STAGES then
      if front.last = '1' then
        ready_o <= '1';
        goes    <= '1';
      elsif rows_v = NO_LINES then
        ready_o <= '1';
      elsif known_v = '0' then
        ready_o <= '1';
        goes    <= '1';
      else
        next_edge_no <= "01";
      end if;
    end if;

    head <= front.last & front.bank & front.triangle & front.z & rows_v & front.columns
            & not known_v;
  end process take_p;

  ends_p : process (edge_no, word_i)
    variable places_v : grid_places_t;
  begin
    for k in grid_places_t'range loop
      places_v(k) := word_i((3 - k) * GRID_POINT_BITS - 2 downto (2 - k) * GRID_POINT_BITS);
    end loop;
    a <= places_v(0);
    b <= places_v(1);
    if edge_no = 1 then
      a <= places_v(1);
      b <= places_v(2);
    elsif edge_no = 2 then
      a <= places_v(2);
      b <= places_v(0);
    end if;
  end process ends_p;

  cut_i : entity raplas.edge_cut
    port map (clk_i => clk_i, a_i => a, b_i => b, error_i => error_i, cut_o => cut);

  head_i : entity raplas.delay
    generic map (WIDTH => head_t'length, STAGES => EDGE_SETUP_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => head, data_o => head_end);
  goes_i : entity raplas.delay
    generic map (STAGES => EDGE_SETUP_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i(0) => goes, data_o(0) => valid_o);

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      edge_no       <= next_edge_no;
      cut_before <= cut;
      cut_first  <= cut_before;
      if rst_i = '1' then
        edge_no <= "00";
      end if;
    end if;
  end process reg_p;

  word_o <= head_end & cut_first & cut_before & cut;

end architecture rtl;
