// Device `rtl`: the VHDL, as Verilator compiles it; one class for each adder.
#include <verilated.h>

#include <stdexcept>

#include "Vintersection_unit_guarded.h"
#include "Vintersection_unit_paper.h"
#include "device_factories.hpp"
#include "raplas/encode.hpp"

namespace raplas {
namespace {

template <typename Unit, typename F>
class RtlDevice final : public IntersectionDevice {
 public:
  explicit RtlDevice(const DeviceOptions& options) : options_(options), unit_(&context_) {
    unit_.rst_i = 1;
    for (int k = 0; k < kResetClocks; ++k) {
      clock();
    }
    unit_.rst_i = 0;
  }
  RtlDevice(const RtlDevice&) = delete;
  RtlDevice& operator=(const RtlDevice&) = delete;
  ~RtlDevice() override { unit_.final(); }

  void load(const DeviceScene& scene) override {
    const SceneMemory<F> memory = encode<F>(scene, options_);
    for (std::size_t k = 0; k < memory.spheres.size(); ++k) {
      write(Target::sphere, k, memory.spheres[k].pack());
    }
    for (std::size_t k = 0; k < memory.triangles.size(); ++k) {
      write(Target::triangle, k, memory.triangles[k].pack());
    }
    write(Target::scene, 0, memory.scene.pack());
    counters_ = {};
    clocks_ = 0;  // from here on: trace() is what is timed
  }

  std::vector<Hit> trace(const Pencil& pencil) override {
    const PencilMemory<F> memory = encode<F>(pencil);
    const auto rows = static_cast<std::size_t>(pencil.rows);
    const auto columns = static_cast<std::size_t>(pencil.columns);
    for (std::size_t r = 0; r < rows; ++r) {
      write(Target::plane, bank_ * (kMaxRows + kMaxColumns) + r, memory.rows[r].pack());
    }
    for (std::size_t c = 0; c < columns; ++c) {
      write(Target::plane, bank_ * (kMaxRows + kMaxColumns) + kMaxRows + c, memory.columns[c].pack());
    }
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        write(Target::ray, bank_ * kMaxRays + r * kMaxColumns + c,
              pack_ray(memory.rays[r * kMaxColumns + c]));
      }
    }
    write(Target::pencil, bank_, memory.pencil.pack());
    run();
    std::vector<Hit> hits = read(rows, columns);
    for (std::size_t k = 0; k < counters_.size(); ++k) {
      counters_[k] += unit_.counters_o[k];
    }
    bank_ ^= 1U;
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t simulated_clocks() const override { return clocks_; }

 private:
  static constexpr int kResetClocks = 4;
  static constexpr std::uint64_t kHangClocks = 100'000'000;

  void clock() {
    unit_.clk_i = 0;
    unit_.eval();
    unit_.clk_i = 1;
    unit_.eval();
    ++clocks_;
  }

  template <std::size_t kWords>
  void write(Target target, std::size_t address, const std::array<std::uint32_t, kWords>& word) {
    unit_.write_i = 1;
    unit_.target_i = static_cast<unsigned char>(target);
    unit_.address_i = static_cast<std::uint32_t>(address);
    for (std::size_t k = 0; k < kWords; ++k) {
      unit_.data_i[k] = word[k];
    }
    clock();
    unit_.write_i = 0;
  }

  /// Starts the pencil of bank_ and waits for its end.
  void run() {
    unit_.start_i = 1;
    unit_.bank_i = static_cast<unsigned char>(bank_);
    clock();
    unit_.start_i = 0;
    for (std::uint64_t k = 0; unit_.busy_o != 0; ++k) {
      if (k == kHangClocks) {
        throw std::runtime_error("device rtl: a pencil did not end within 100 million clocks");
      }
      clock();
    }
  }

  /// Results of bank_, one address a clock, data kMemoryStages later.
  std::vector<Hit> read(std::size_t rows, std::size_t columns) {
    std::vector<Hit> hits;
    hits.reserve(rows * columns);
    for (std::size_t k = 0; k < rows * columns + kMemoryStages - 1; ++k) {
      if (k < rows * columns) {
        unit_.result_ray_i =
            static_cast<unsigned short>(bank_ * kMaxRays + k / columns * kMaxColumns + k % columns);
      }
      clock();
      if (k + 1 >= kMemoryStages) {
        PackedWord<ResultLayout::kBits> word{};
        for (std::size_t i = 0; i < word.size(); ++i) {
          word[i] = unit_.result_o[i];
        }
        hits.push_back(decode(ResultWord<F>::unpack(word)));
      }
    }
    return hits;
  }

  DeviceOptions options_;
  VerilatedContext context_;
  Unit unit_;
  Counters counters_{};
  std::uint64_t clocks_ = 0;
  std::size_t bank_ = 0;
};

}  // namespace

std::unique_ptr<IntersectionDevice> make_rtl_device(const DeviceOptions& options) {
  if (options.guard_bits) {
    return std::make_unique<RtlDevice<Vintersection_unit_guarded, Fp24>>(options);
  }
  return std::make_unique<RtlDevice<Vintersection_unit_paper, Fp24Paper>>(options);
}

}  // namespace raplas
