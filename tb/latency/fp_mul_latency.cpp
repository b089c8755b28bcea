// Latency of fp_mul.
#include "latency.hpp"
#include "operands.hpp"
#include "raplas/float.hpp"

namespace raplas {
namespace {

TEST(Latency, OfFpMulIsItsStages) {
  OperandPairs pairs(302);
  const auto make = [&pairs]() -> Operands {
    const auto [a, b] = pairs();
    const Fp24 product = Fp24::from_bits(a) * Fp24::from_bits(b);
    return {{port_value("a_i", a), port_value("b_i", b)}, {port_value("product_o", product.bits())}};
  };
  check_latency(operands_in_turn(20, make), kMulStages);
}

}  // namespace
}  // namespace raplas
