// Device `rtl`: the VHDL, as Verilator compiles it.
#include <verilated.h>

#include <memory>
#include <stdexcept>

#include "Vintersection_unit.h"
#include "Vraplas_unit.h"
#include "device_factories.hpp"
#include "exact_device.hpp"
#include "raplas/encode.hpp"

namespace raplas {
namespace {

/// What both units' classes of Verilator have in common.
template <typename Unit>
class Verilated {
 public:
  Verilated() : unit_(&context_) {
    unit_.rst_i = 1;
    for (int k = 0; k < kResetClocks; ++k) {
      clock();
    }
    unit_.rst_i = 0;
  }
  Verilated(const Verilated&) = delete;
  Verilated& operator=(const Verilated&) = delete;
  ~Verilated() { unit_.final(); }

  void clock() {
    unit_.clk_i = 0;
    unit_.eval();
    unit_.clk_i = 1;
    unit_.eval();
  }

  /// A word for the write port in the next clock.
  template <std::size_t kWords>
  void set_write(Target target, std::size_t address, const std::array<std::uint32_t, kWords>& word) {
    unit_.write_i = 1;
    unit_.target_i = static_cast<unsigned char>(target);
    unit_.address_i = static_cast<std::uint32_t>(address);
    for (std::size_t k = 0; k < kWords; ++k) {
      unit_.data_i[k] = word[k];
    }
  }

  template <std::size_t kWords>
  void write(Target target, std::size_t address, const std::array<std::uint32_t, kWords>& word) {
    set_write(target, address, word);
    clock();
    unit_.write_i = 0;
  }

  /// The port result_o as a ResultWord or a RayHits.
  template <typename Word>
  [[nodiscard]] Word result() const {
    decltype(Word{}.pack()) word{};
    for (std::size_t i = 0; i < word.size(); ++i) {
      word[i] = unit_.result_o[i];
    }
    return Word::unpack(word);
  }

  Unit* operator->() { return &unit_; }
  const Unit* operator->() const { return &unit_; }

 private:
  static constexpr int kResetClocks = 4;

  VerilatedContext context_;
  Unit unit_;
};

/// Profile paper: one pencil after the other.
class PaperRtlDevice final : public IntersectionDevice {
 public:
  using F = Fp24Paper;

  explicit PaperRtlDevice(const DeviceOptions& options) : options_(options) {}

  void load(const DeviceScene& scene) override {
    const SceneMemory<F> memory = encode<F>(scene, options_);
    for (std::size_t k = 0; k < memory.spheres.size(); ++k) {
      unit_.write(Target::sphere, k, memory.spheres[k].pack());
    }
    for (std::size_t k = 0; k < memory.triangles.size(); ++k) {
      unit_.write(Target::triangle, k, memory.triangles[k].pack());
    }
    unit_.write(Target::scene, 0, memory.scene.pack());
    counters_ = {};
    clocks_ = 0;  // from here on: trace() is what is timed
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> hits;
    hits.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      hits.push_back(trace_one(pencil));
    }
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t simulated_clocks() const override { return clocks_; }

 private:
  static constexpr std::uint64_t kHangClocks = 100'000'000;

  std::vector<Hit> trace_one(const Pencil& pencil) {
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
    drop_far_hits(pencil, hits);
    for (std::size_t k = 0; k < counters_.size(); ++k) {
      counters_[k] += unit_->counters_o[k];
    }
    bank_ ^= 1U;
    return hits;
  }

  template <std::size_t kWords>
  void write(Target target, std::size_t address, const std::array<std::uint32_t, kWords>& word) {
    unit_.write(target, address, word);
    ++clocks_;
  }

  void clock() {
    unit_.clock();
    ++clocks_;
  }

  /// Starts the pencil of bank_ and waits for its end.
  void run() {
    unit_->start_i = 1;
    unit_->bank_i = static_cast<unsigned char>(bank_);
    clock();
    unit_->start_i = 0;
    for (std::uint64_t k = 0; unit_->busy_o != 0; ++k) {
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
        unit_->result_ray_i =
            static_cast<unsigned short>(bank_ * kMaxRays + k / columns * kMaxColumns + k % columns);
      }
      clock();
      if (k + 1 >= kMemoryStages) {
        hits.push_back(decode(unit_.result<ResultWord<F>>()));
      }
    }
    return hits;
  }

  DeviceOptions options_;
  Verilated<Vintersection_unit> unit_;
  Counters counters_{};
  std::uint64_t clocks_ = 0;
  std::size_t bank_ = 0;
};

/// The RTL as FixedDevice drives it.
class RtlUnit {
 public:
  void load(const FixedSceneMemory<Fp24>& scene) {
    unit_ = std::make_unique<Verilated<Vraplas_unit>>();
    for (std::size_t k = 0; k < scene.nodes.size(); ++k) {
      unit_->write(Target::sphere, k, scene.nodes[k].pack());
    }
    for (std::size_t k = 0; k < scene.vertices.size(); ++k) {
      unit_->write(Target::vertex, k, scene.vertices[k].pack());
    }
    for (std::size_t k = 0; k < scene.triangles.size(); ++k) {
      unit_->write(Target::triangle, k, scene.triangles[k].pack());
    }
    unit_->write(Target::scene, 0, scene.scene.pack());
  }

  void write_pencil_word(const FixedPencilMemory<Fp24>& pencil, std::size_t bank, std::size_t word) {
    const HostWord host = pencil_word(pencil, bank, word);
    unit_->set_write(host.target, host.address, host.data);
  }

  void ask(std::size_t bank, std::size_t ray) {
    unit()->result_ray_i = static_cast<unsigned short>(bank * kMaxRays + ray);
  }

  void clock(bool start, std::size_t bank) {
    unit()->start_i = start ? 1 : 0;
    unit()->bank_i = static_cast<unsigned char>(bank);
    unit_->clock();
    unit()->write_i = 0;
  }

  [[nodiscard]] std::uint32_t busy() const { return (*unit_)->busy_o; }
  [[nodiscard]] LineMask hit_rows(std::size_t bank) const {
    return static_cast<LineMask>((*unit_)->hit_rows_o >> (bank * kMaxRows) & ((1U << kMaxRows) - 1));
  }
  [[nodiscard]] RayHits<Fp24> result() const { return unit_->result<RayHits<Fp24>>(); }
  [[nodiscard]] EventCounters counters() const {
    EventCounters counters{};
    for (std::size_t k = 0; k < counters.size(); ++k) {
      counters[k] = (*unit_)->counters_o[k];
    }
    return counters;
  }

 private:
  Verilated<Vraplas_unit>& unit() { return *unit_; }

  std::unique_ptr<Verilated<Vraplas_unit>> unit_;
};

}  // namespace

std::unique_ptr<IntersectionDevice> make_rtl_device(const DeviceOptions& options) {
  if (options.profile == Profile::paper) {
    return std::make_unique<PaperRtlDevice>(options);
  }
  return make_fixed_device<RtlUnit>(options);
}

}  // namespace raplas
