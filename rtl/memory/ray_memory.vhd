-- ============================================================================
-- ray_memory - directions of rays: written WORD_RAYS at a time, read one by one
-- ----------------------------------------------------------------------------
--   @2  direction of the ray asked for           ram, one for each ray of a word
-- The first ray of a word is in its low bits.
-- model: cmodel/include/raplas/host_port.hpp     tests: tb/integration/raplas_unit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity ray_memory is
  port (
    clk_i          : in  std_ulogic;
    write_i        : in  std_ulogic;
    write_group_i  : in  std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - WORD_RAYS_LOG2 - 1 downto 0);
    write_data_i   : in  std_ulogic_vector(2 ** WORD_RAYS_LOG2 * RAY_BITS - 1 downto 0);
    read_address_i : in  std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - 1 downto 0);   -- bank, ray
    read_data_o    : out ray_word_t                                  -- MEMORY_STAGES later
  );
end entity ray_memory;

architecture rtl of ray_memory is
  constant ADDRESS_BITS : positive := BANK_BITS + 2 * LINE_BITS - WORD_RAYS_LOG2;
  constant WORD_RAYS    : positive := 2 ** WORD_RAYS_LOG2;
  type words_t is array (0 to WORD_RAYS - 1) of ray_word_t;
  signal word     : std_ulogic_vector(ADDRESS_BITS - 1 downto 0);
  signal words    : words_t;
  signal place    : std_ulogic_vector(WORD_RAYS_LOG2 - 1 downto 0);   -- in its word
  signal place_s2 : std_ulogic_vector(WORD_RAYS_LOG2 - 1 downto 0);
begin

  word  <= read_address_i(BANK_BITS + 2 * LINE_BITS - 1 downto WORD_RAYS_LOG2);
  place <= read_address_i(WORD_RAYS_LOG2 - 1 downto 0);

  rays_g : for k in words_t'range generate
    ram_i : entity raplas.ram
      generic map (WIDTH => RAY_BITS, ADDRESS_BITS => ADDRESS_BITS)
      port map (
        clk_i           => clk_i,
        write_i         => write_i,
        write_address_i => write_group_i,
        write_data_i    => write_data_i((k + 1) * RAY_BITS - 1 downto k * RAY_BITS),
        read_address_i  => word,
        read_data_o     => words(k)
      );
  end generate rays_g;

  place_delay : entity raplas.delay
    generic map (WIDTH => WORD_RAYS_LOG2, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => place, data_o => place_s2);

  select_p : process (words, place_s2)
  begin
    read_data_o <= words(0);
    for k in 1 to WORD_RAYS - 1 loop
      if unsigned(place_s2) = k then
        read_data_o <= words(k);
      end if;
    end loop;
  end process select_p;

end architecture rtl;
