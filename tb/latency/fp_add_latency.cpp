// Latency of fp_add.
#include "latency.hpp"
#include "operands.hpp"
#include "raplas/float.hpp"

namespace raplas {
namespace {

TEST(Latency, OfFpAddIsItsStages) {
  OperandPairs pairs(301);
  const auto make = [&pairs]() -> Operands {
    const auto [a, b] = pairs();
    const Fp24 sum = Fp24::from_bits(a) + Fp24::from_bits(b);
    return {{port_value("a_i", a), port_value("b_i", b)}, {port_value("sum_o", sum.bits())}};
  };
  check_latency(operands_in_turn(20, make), kAddStages);
}

}  // namespace
}  // namespace raplas
