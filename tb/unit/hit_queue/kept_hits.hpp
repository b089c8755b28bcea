// What hit_queue keeps of each hit: the rule of docs/hit_queue.md case by case, with exact products in MPFR.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "oracle.hpp"
#include "raplas/ray_triangle.hpp"
#include "support/depth_place.hpp"

namespace raplas {

/// t/d of `a` is below that of `b`, or equal and its triangle has the lower ID.
inline bool before(const ResultWord<Fp24>& a, const ResultWord<Fp24>& b) {
  const auto product = [](Fp24 x, Fp24 y) {
    oracle::Real result;
    mpfr_mul(result.get(), oracle::Real(x.bits()).get(), oracle::Real(y.bits()).get(), MPFR_RNDN);  // exact
    return result;
  };
  const int order = mpfr_cmp(product(a.t, b.d).get(), product(b.t, a.d).get());
  return order < 0 || (order == 0 && a.triangle < b.triangle);
}

/// What becomes of a hit.
enum Outcome : std::size_t {
  kFirst,       // of its ray
  kNearer,      // than the one kept, which is forgotten
  kFarther,     // forgotten
  kKnown,       // its triangle is in the word
  kTieNearer,   // and the one kept is its rival
  kTieFarther,  // it is the rival
  kSurer,       // the one kept, unsure, is its rival
  kUnsure,      // it is a rival of one whose depth is known
  kBothUnsure,  // it is a rival of one whose depth isn't known either
  kTie,         // of depths known well
  kRoughTie,    // that would be none if they were known well
  kCrowd,       // there was a rival already
  kCrowded,     // there was a crowd already
  kRivalStays,  // an unsure one, though the hit is nearer than the one kept
  kRivalGoes,   // it was no farther than the one kept, which is farther than the hit
  kEnds,        // two are enough
  kOutcomes
};

struct Decision {
  std::vector<Outcome> outcomes;
  bool write = false;
  bool bounds = false;
  std::uint32_t bound = 0;
  RayHits<Fp24> word;
};

/// The rule, case by case.
inline Decision decide(const FoundHit<Fp24>& hit, const RayHits<Fp24>& word) {
  const ResultWord<Fp24>& r = hit.result;
  const ResultWord<Fp24>& best = word.nearest;
  const auto alone = [&](Outcome outcome) {  // the hit, and nothing else
    Decision d{{outcome}, true, true, hit.bound, {}};
    d.word.nearest = r;
    d.word.nearest.hit = true;
    d.word.rough = hit.rough;
    d.word.unsure = hit.unsure;
    return d;
  };
  if (!best.hit) {
    return alone(kFirst);
  }
  if (!hit.certify) {
    return before(r, best) ? alone(kNearer) : Decision{{kFarther}, false, false, 0, {}};
  }
  if (word.crowd) {
    return {{kCrowded}, false, false, 0, {}};
  }
  if (r.triangle == best.triangle || (word.rival && r.triangle == word.rival_triangle)) {
    return {{kKnown}, false, false, 0, {}};
  }
  const bool known = !hit.unsure && !word.unsure;  // both depths
  const bool rough = hit.rough || word.rough;
  if (known && !tied(r.t.bits(), r.d.bits(), best.t.bits(), best.d.bits(), rough)) {
    if (!before(r, best)) {
      return {{kFarther}, false, false, 0, {}};
    }
    Decision d = alone(kNearer);
    if (word.rival && word.rival_rough) {
      d.word.rival = true;
      d.word.rival_rough = true;
      d.outcomes.push_back(kRivalStays);
    } else if (word.rival) {
      d.outcomes.push_back(kRivalGoes);
    }
    d.word.rival_triangle = word.rival_triangle;  // without a rival it means nothing
    return d;
  }
  // either may be nearer: one is kept as the nearest, the other is its rival
  const bool wins = known ? before(r, best) : !hit.unsure;
  Decision d = wins ? alone(known ? kTieNearer : kSurer)
                    : Decision{{known         ? kTieFarther
                                : word.unsure ? kBothUnsure
                                              : kUnsure},
                               true,
                               false,
                               0,
                               word};
  d.word.rival = true;
  const bool sure = wins ? !word.rough && !word.unsure : !hit.rough && !hit.unsure;  // the rival's
  d.word.rival_rough = !sure;
  if (known && tied(r.t.bits(), r.d.bits(), best.t.bits(), best.d.bits()) != rough) {
    d.outcomes.push_back(rough ? kRoughTie : kTie);
  }
  d.word.rival_triangle = wins ? best.triangle : r.triangle;
  if (word.rival) {
    d.word.crowd = true;
    d.outcomes.push_back(kCrowd);
  }
  if (hit.ends) {
    d.outcomes.push_back(kEnds);
  }
  if (word.rival || hit.ends) {  // nothing matters to this ray any more
    d.bounds = true;
    d.bound = 0;
  }
  return d;
}

}  // namespace raplas
