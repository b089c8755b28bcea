// hit_queue: the words in order, each in its clock, by a list of the times at which places (bank and ray)
// were last read; what is kept of each ray by exact products in MPFR, and by the rule of docs/hit_queue.md;
// and the model clock by clock. The bench plays the Result memory.
#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "kept_hits.hpp"
#include "raplas/hit_queue.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const int kClocks = Dut::simulator() == "ghdl" ? 6'000 : 40'000;
constexpr int kRays = kMaxRows * kMaxColumns;
constexpr int kHazard = kMemoryStages + kMulStages + 1;
constexpr int kLatency = kMemoryStages + kMulStages;
constexpr std::size_t kUnderWay = 30;  // clocks from a pair to its hit
const PortStage kWriteStage{"write_o", kLatency};
const PortStage kDoneStage{"done_o", kLatency};

using Word = RayHits<Fp24>;
using Hit = ValidHit<Fp24>;

struct Pattern {
  unsigned hit_percent;  // of the clocks in which pairs may go
  unsigned rays;
  unsigned token_percent;
  unsigned certify_percent = 0;  // of the pencils
  unsigned unsure_percent = 0;   // of the hits of those
  unsigned rough_percent = 0;
};

class HitQueueBench : public testing::Test {
 protected:
  void run(Pattern pattern, int clocks = kClocks) {
    pattern_ = pattern;
    reset_dut();
    for (int k = 0; k < clocks && !HasFailure(); ++k) {
      clock(k, true);
    }
    for (int k = clocks; (k < clocks + 2000) && !HasFailure(); ++k) {  // all that waits comes out
      clock(k, false);
    }
    EXPECT_TRUE(waiting_.empty());
    EXPECT_GT(writes_, 0);
    EXPECT_EQ(dones_, tokens_);
  }

  /// Every outcome came so often.
  void expect_outcomes(int least) const {
    for (std::size_t k = 0; k < kOutcomes; ++k) {
      EXPECT_GE(outcomes_[k], Dut::simulator() == "ghdl" ? least / 10 : least) << "outcome " << k;
    }
  }

  void clock(int now, bool more) {
    // pairs under way: a stalled one comes to nothing
    std::optional<Hit> given;
    under_way_.push_back(more && !model_.stall() ? make() : std::nullopt);
    if (under_way_.size() > kUnderWay) {
      given = under_way_.front();
      under_way_.pop_front();
    }
    apply(given);
    Word best = asked_.size() == kMemoryStages ? asked_.back() : Word{};
    dut().set(dut().port("best_i"), best.pack());
    best = best.nearest.hit ? best : Word{};  // without a hit all else means nothing
    dut().settle();
    check(now);

    // the word at the front goes when its place was not read in the last clocks
    std::optional<Hit> goes;
    if (!waiting_.empty()) {
      const Hit& front = waiting_.front();
      const std::uint32_t place = front.bank * kRays + front.ray;
      const auto last = read_.find(place);
      if (front.token || last == read_.end() || now - last->second >= kHazard) {
        goes = front;
        if (!front.token) {
          read_[place] = now;
        }
      }
      if (!front.token) {
        expect_port(dut().port("best_bank_o"), front.bank, "best_bank_o");
        expect_port(dut().port("best_ray_o"), front.ray, "best_ray_o");
      }
    }
    // the memory answers to what the unit asks: what it held in this clock, or anything if that is being
    // written
    const auto asked = static_cast<std::size_t>(dut().get(dut().port("best_bank_o")) * kRays +
                                                dut().get(dut().port("best_ray_o")));
    asked_.push_front(asked == written_ ? any_word() : memory_[asked]);
    if (asked_.size() > kMemoryStages) {
      asked_.pop_back();
    }
    if (written_ < memory_.size()) {
      memory_[written_] = word_;
    }
    gone_.push_front(goes);
    if (gone_.size() > kLatency) {
      gone_.pop_back();
    }
    if (goes) {
      waiting_.pop_front();
    }
    if (given) {
      waiting_.push_back(*given);
      most_ = std::max(most_, waiting_.size());
    }
    model_.clock(given.has_value(), given.value_or(Hit{}), best);
    dut().clock();
  }

  /// A clock of rst_i: nothing that was inside comes out, neither here nor in the bench.
  void forget() {
    apply(std::nullopt);
    dut().set(dut().port("rst_i"), 1);
    dut().clock();
    dut().set(dut().port("rst_i"), 0);
    for (int k = 0; k < 80 && !HasFailure(); ++k) {
      dut().settle();
      for (const char* name : {"write_o", "bounds_o", "first_o", "done_o", "stall_o"}) {
        expect_port(dut().port(name), 0, name);
      }
      dut().clock();
    }
    model_ = {};
    under_way_.clear();
    waiting_.clear();
    gone_.clear();
    asked_.clear();
    read_.clear();
    forget_hits(memory_);
    forget_hits(kept_);
    tokens_ = dones_ = 0;
  }

  /// A hit or a token of the running pencil; no pencil starts in a bank before the one before in it is done.
  std::optional<Hit> make() {
    if (tokens_ - dones_ >= kPencilBanks || random_() % 100 >= pattern_.hit_percent) {
      return std::nullopt;
    }
    Hit hit;
    hit.bank = static_cast<std::uint32_t>(tokens_ % kPencilBanks);
    hit.token = random_() % 100 < pattern_.token_percent;
    hit.ray = static_cast<std::uint32_t>(random_() % pattern_.rays) * 37 % kRays;
    tokens_ += hit.token ? 1 : 0;
    const auto bits = [this](unsigned n) { return static_cast<std::uint32_t>(random_() & ((1U << n) - 1)); };
    const auto any = [&bits] { return Fp24::from_bits(bits(24)); };
    if (random_() % 2 == 0) {  // t/d is one of a few, in several spellings
      const std::uint32_t scale = bits(2) << 16;
      hit.hit.result = {false,
                        bits(2) << bits(4),
                        Fp24::from_bits(0x3e8000 + (bits(1) << bits(4)) + scale),
                        Fp24::from_bits(0x3f4000 + scale),
                        any(),
                        any()};
    } else {
      const auto positive = [&bits] { return Fp24::from_bits(0x3d0000 + bits(18)); };
      hit.hit.result = {false, bits(kIdBits), positive(), positive(), any(), any()};
    }
    hit.hit.bound = bits(kDepthBits);
    const auto pencil = static_cast<std::uint32_t>(tokens_ - (hit.token ? 1 : 0));
    hit.hit.certify = pencil * 37 % 100 < pattern_.certify_percent;
    if (hit.hit.certify) {
      hit.hit.ends = pencil % 4 == 3;
      hit.hit.unsure = hit.hit.ends || random_() % 100 < pattern_.unsure_percent;
      hit.hit.rough = random_() % 100 < pattern_.rough_percent;
      if (random_() % 4 != 0) {  // depths that are a tie or nearly, many triangles or few
        hit.hit.result.triangle = bits(2) << bits(4) % 3 * 9;
        hit.hit.result.t = Fp24::from_bits(0x3e8000 + bits(12) - (bits(1) << 11));
        hit.hit.result.d = Fp24::from_bits(0x3f4000 + bits(3));
      }
      if (hit.hit.unsure && random_() % 2 == 0) {  // they say nothing
        (random_() % 2 == 0 ? hit.hit.result.t : hit.hit.result.d) = any();
      }
    }
    return hit;
  }

  static void forget_hits(std::vector<Word>& words, std::size_t first = 0,
                          std::size_t count = ~std::size_t{0}) {
    for (std::size_t k = first; k < words.size() && k - first < count; ++k) {
      words[k].nearest.hit = false;
    }
  }

  /// Anything but a hit.
  Word any_word() {
    PackedWord<RayHitsLayout::kBits> bits{};
    std::generate(bits.begin(), bits.end(), [this] { return static_cast<std::uint32_t>(random_()); });
    insert(bits, RayHitsLayout::hit, 0);
    return Word::unpack(bits);
  }

  void apply(const std::optional<Hit>& given) {
    const auto set = [](const char* name, std::uint64_t value) { dut().set(dut().port(name), value); };
    const Hit hit = given.value_or(Hit{});
    set("valid_i", given && !hit.token ? 1 : 0);
    set("last_i", given && hit.token ? 1 : 0);
    set("bank_i", hit.bank);
    set("ray_i", hit.ray);
    set("triangle_i", hit.hit.result.triangle);
    set("t_i", hit.hit.result.t.bits());
    set("d_i", hit.hit.result.d.bits());
    set("u_i", hit.hit.result.u.bits());
    set("v_i", hit.hit.result.v.bits());
    set("bound_i", hit.hit.bound);
    set("certify_i", hit.hit.certify ? 1 : 0);
    set("rough_i", hit.hit.rough ? 1 : 0);
    set("unsure_i", hit.hit.unsure ? 1 : 0);
    set("ends_i", hit.hit.ends ? 1 : 0);
  }

  void check(int now) {
    const auto expect = [](const char* name, std::uint64_t value) {
      expect_port(dut().port(name), value, name);
    };
    written_ = memory_.size();
    const std::optional<Hit> due = gone_.size() == kLatency ? gone_.back() : std::nullopt;
    Decision decision;
    bool first = false;
    if (due && !due->token) {
      const std::size_t place = due->bank * std::size_t{kRays} + due->ray;
      first = !kept_[place].nearest.hit;
      decision = decide(due->hit, kept_[place]);
      for (const Outcome outcome : decision.outcomes) {
        ++outcomes_[outcome];
      }
      if (decision.write) {
        kept_[place] = decision.word;
        written_ = place;
        word_ = decision.word;
        ++writes_;
        expect_port(dut().port("result_o"), word_.pack(), "result_o");
        expect("write_bank_o", due->bank);
        expect("ray_o", due->ray);
        if (decision.bounds) {
          expect("bound_o", decision.bound);
        }
      }
    }
    const bool done = due && due->token;
    expect("write_o", decision.write ? 1 : 0);
    expect("bounds_o", decision.bounds ? 1 : 0);
    expect("first_o", first ? 1 : 0);
    expect("done_o", done ? 1 : 0);
    expect("stall_o", waiting_.size() >= std::size_t{1} << (kHitFifoDepthLog2 - 1) ? 1 : 0);
    if (done) {  // the memory holds what is kept of the pencil; a new one starts with no hits
      ++dones_;
      expect("done_bank_o", due->bank);
      const auto begin = due->bank * std::size_t{kRays};
      for (std::size_t k = begin; k < begin + kRays; ++k) {
        ASSERT_EQ(kept_[k].nearest.hit, memory_[k].nearest.hit);
        ASSERT_TRUE(!kept_[k].nearest.hit || kept_[k] == memory_[k]);
      }
      forget_hits(kept_, begin, kRays);
      forget_hits(memory_, begin, kRays);
    }
    const NearestHit<Fp24>& model = model_.out();
    ASSERT_EQ(model.kept.write, decision.write) << "model, clock " << now;
    ASSERT_EQ(model.kept.write && model.kept.first, first) << "model, clock " << now;
    ASSERT_EQ(model.done, done) << "model, clock " << now;
    ASSERT_EQ(model_.count(), waiting_.size());
    if (decision.write) {
      ASSERT_EQ(model.kept.word, word_);
      ASSERT_EQ(model.bank * kRays + model.ray, written_);
      ASSERT_EQ(model.kept.bounds, decision.bounds);
      ASSERT_TRUE(!decision.bounds || model.kept.bound == decision.bound);
    }
    if (done) {
      ASSERT_EQ(model.bank, due->bank);
    }
  }

  Pattern pattern_{};
  std::mt19937 random_{141};
  HitQueue<Fp24> model_;
  std::deque<std::optional<Hit>> under_way_;
  std::deque<Hit> waiting_;              // in the queue
  std::deque<std::optional<Hit>> gone_;  // in the last clocks, the youngest first
  std::deque<Word> asked_;               // answers on their way, the youngest first
  std::map<std::uint32_t, int> read_;    // clock in which a place was last read
  std::vector<Word> memory_ = std::vector<Word>(std::size_t{kPencilBanks} * kRays);
  std::vector<Word> kept_ = memory_;  // of each ray
  std::size_t written_ = memory_.size();
  Word word_;
  int tokens_ = 0;
  int dones_ = 0;
  int writes_ = 0;
  std::array<int, kOutcomes> outcomes_{};
  std::size_t most_ = 0;
};

TEST_F(HitQueueBench, TakesAHitEveryClock) { run({100, kRays, 1}); }
TEST_F(HitQueueBench, HoldsBackTheSameRayAndStallsInTime) {
  run({100, 1, 2});
  EXPECT_GT(most_, HitQueue<Fp24>::kDepth / 2 + 20) << "the queue was never nearly full";
  EXPECT_LT(most_, HitQueue<Fp24>::kDepth);
}
TEST_F(HitQueueBench, IsExactAtTheEdgeOfTheWindow) { run({90, 6, 1}); }
TEST_F(HitQueueBench, CountsIdleClocksToo) { run({30, 4, 3}); }
TEST_F(HitQueueBench, LetsPencilsOverlap) { run({100, 3, 25}); }
TEST_F(HitQueueBench, LetsTokensPassAlone) { run({20, 5, 60}); }

TEST_F(HitQueueBench, KeepsARivalOfCertifiedHits) {
  run({100, 60, 1, 75, 15, 25});
  expect_outcomes(50);
}
TEST_F(HitQueueBench, KeepsARivalOfCertifiedHitsThatComeSeldom) { run({40, 40, 2, 100, 50, 50}); }
TEST_F(HitQueueBench, KnowsCrowdsOfCertifiedHits) { run({100, 6, 3, 100, 5, 5}); }

TEST_F(HitQueueBench, ForgetsWhatWaitsWhenReset) {
  pattern_ = {100, 1, 0};
  reset_dut();
  for (int k = 0; k < 200 && !HasFailure(); ++k) {
    clock(k, true);
  }
  EXPECT_GT(waiting_.size(), HitQueue<Fp24>::kDepth / 2);
  forget();
}

TEST_F(HitQueueBench, ForgetsWhatIsUnderWayWhenReset) {
  pattern_ = {100, kRays, 30, 50, 30};
  reset_dut();
  for (int k = 0; k < 30 && !HasFailure(); ++k) {
    for (int clocks = 0; clocks < 60 + k && !HasFailure(); ++clocks) {
      clock(clocks, true);
    }
    forget();
  }
}

}  // namespace
}  // namespace raplas
