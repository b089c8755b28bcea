# What docs/radius.md multiplies each term of n.c + p with on its way through the tester:
#   q   rounding n (or p) to the nearest fp24
#   m   the multiplication (p has none)
#   a b the two additions; either adder gives x (1 + a) + y (1 + a'), each factor of its own
# The error of the distance is at most this factor's distance from 1, times the sum of the terms' magnitudes.
{ |q| <= 1b-17 /\ |m| <= 1b-16 /\ |a| <= 1b-16 /\ |b| <= 1b-16
  -> |(1 + q) * (1 + m) * (1 + a) * (1 + b) - 1| in ? }
