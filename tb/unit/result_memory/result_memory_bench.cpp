// result_memory against arrays: two banks, clearing, both read ports.
#include <random>

#include "raplas/words.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kPencils = 12;
constexpr int kClocksPerPencil = 1'500;
constexpr int kClearClocks = kMaxRows + 1;
constexpr std::size_t kRays = std::size_t{kMaxRows} * kMaxColumns;

TEST(ResultMemory, KeepsTheLastWriteOfEachRayAndForgetsWhenCleared) {
  using Word = ResultWord<Fp24>;
  std::mt19937 random(101);
  reset_dut();
  std::array<std::array<Word, kRays>, 2> banks{};
  std::array<bool, 2> filled{};
  const auto hit_of = [](const Word& word) { return word.hit; };
  for (int pencil = 0; pencil < kPencils; ++pencil) {
    const auto bank = static_cast<std::size_t>(pencil % 2);
    Scoreboard<std::array<Word, 2>> board(kMemoryStages);
    for (int k = 0; k < kClocksPerPencil && !testing::Test::HasFailure(); ++k) {
      const auto ray = static_cast<std::size_t>(random() % kRays);
      const bool write = k > kClearClocks && random() % 4 == 0;
      const auto number = [&random] {
        return Fp24::from_bits(static_cast<std::uint32_t>(random() & 0xffffff));
      };
      const Word word{true,    static_cast<std::uint32_t>(random() & 0xfffff), number(), number(), number(),
                      number()};
      // neither port reads what is written in this clock: pair_issue sees to that
      std::size_t best_ray = random() % kRays;
      best_ray = best_ray == ray ? (ray + 1) % kRays : best_ray;
      const auto host_bank = static_cast<std::size_t>(random() % 2);
      std::size_t host_ray = random() % kRays;
      host_ray = host_ray == ray ? (ray + 1) % kRays : host_ray;
      if (k == 0) {
        banks[bank].fill({});
        filled[bank] = true;
      }
      dut().set(dut().port("clear_i"), k == 0 ? 1 : 0);
      dut().set(dut().port("bank_i"), bank);
      dut().set(dut().port("write_i"), write ? 1 : 0);
      dut().set(dut().port("write_ray_i"), ray);
      dut().set(dut().port("write_data_i"), word.pack());
      dut().set(dut().port("best_ray_i"), best_ray);
      dut().set(dut().port("host_ray_i"), host_bank * kRays + host_ray);
      const std::array<Word, 2> expected{banks[bank][best_ray], banks[host_bank][host_ray]};
      const auto due = board.clock(expected);
      if (due && k > kClearClocks + kMemoryStages && filled[0] && filled[1]) {
        const std::array<const char*, 2> names{"best_o", "host_data_o"};
        for (std::size_t port = 0; port < 2; ++port) {
          PackedWord<ResultLayout::kBits> seen{};
          dut().get(dut().port(names[port]), seen);
          const Word result = Word::unpack(seen);
          ASSERT_EQ(hit_of(result), hit_of((*due)[port])) << names[port] << " in clock " << k;
          if (result.hit) {
            ASSERT_EQ(result, (*due)[port]) << names[port] << " in clock " << k;
          }
          count_checked();
        }
      }
      if (write) {
        banks[bank][ray] = word;
      }
    }
  }
}

}  // namespace
}  // namespace raplas
