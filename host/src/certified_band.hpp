// The error band of certified hits: docs/exact.md derives these numbers.
#pragma once

namespace raplas {

/// What rounding a number to fp24 changes it by, at most, as a share of it.
inline constexpr double kRounding = 0x1p-17;

/// u', v' and d - u' - v' of a triangle whose longer edge from V0 is L, scaled by s, are off by at most
///   kRounding |D| s L (kOriginError (|V0| + |O|) + kEdgeError L),
/// and triangles are scaled so that s L (..) is kBandError for |O| = 1: that of a small triangle at |V0| = 1.
inline constexpr double kOriginError = 4.16;
inline constexpr double kEdgeError = 26;
inline constexpr double kBandError = 2 * kOriginError;

/// Below that a triangle's largest component of N is too near the end of the format.
inline constexpr double kLeastNormal = 0x1p-36;

/// No ray of a pencil is longer than that at a depth of 1, and no origin farther from zero.
inline constexpr double kLongestRay = 64;
inline constexpr double kFarthestOrigin = 1;

/// More than all that is left out: terms of second order, and double precision.
inline constexpr double kBandMargin = 1 + 0x1p-8;

/// In depth codes: what the code of a quotient may be above that of the true depth, if this isn't unsure.
inline constexpr unsigned kDepthCodeError = 32;

}  // namespace raplas
