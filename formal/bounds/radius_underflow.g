# What underflow adds to the tester's error, in units of 2^-62, but for the rounding of n:
#   z1 z2 z3  products that become 0, zp rounding p; they go through two additions
#   zs zt     the first two sums; they go through one
#   zd        the last sum
# A flushed product has no relative error; the additions after it have (a of the first, b of the second).
{ |z1| <= 1 /\ |z2| <= 1 /\ |z3| <= 1 /\ |zp| <= 0.5 /\ |zs| <= 1 /\ |zt| <= 1 /\ |zd| <= 1 /\
  |a1| <= 1b-16 /\ |a2| <= 1b-16 /\ |a3| <= 1b-16 /\ |ap| <= 1b-16 /\ |bs| <= 1b-16 /\ |bt| <= 1b-16
  -> |(z1 * (1 + a1) + z2 * (1 + a2) + zs) * (1 + bs) + (z3 * (1 + a3) + zp * (1 + ap) + zt) * (1 + bt) + zd| in ? }
