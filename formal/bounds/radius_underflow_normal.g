# What underflow adds when a coordinate of n is rounded to 0 or 2^-62, for a coordinate 1 of the centre, in units of
# 2^-62: q is the loss, m, a, b as in radius_factor.g.
{ |q| <= 0.5 /\ |m| <= 1b-16 /\ |a| <= 1b-16 /\ |b| <= 1b-16
  -> |q * (1 + m) * (1 + a) * (1 + b)| in ? }
