// SPDX-License-Identifier: Apache-2.0
// rule: noise is 1/2 at integers, within 0..1, of mean 1/2, the same for the same argument; colours have independent channels.
// spec: RI 3.2, Shading Language, noise
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface noise_rules()
{
    BEGIN_CHECKS
    float zero = s - s, sum = 0, low = 1, high = 0;
    float i;
    CHECK("at an integer", noise(zero + 7), .5, 1e-6)
    CHECK("at a lattice point", noise(point(3, -4, 5) + vector(zero, 0, 0)), .5, 1e-6)
    CHECK("2-D lattice point", noise(zero + 2, zero - 9), .5, 1e-6)
    CHECK("4-D lattice point", noise(point(zero, 1, 2), 3), .5, 1e-6)
    CHECK("same argument", noise(P * 3.7), noise(P * 3.7), 0)
    for (i = 0; i < 4000; i += 1) {
        float n = noise(point(i * .37 + s, i * .71 + t, i * .13));
        sum += n;
        low = min(low, n);
        high = max(high, n);
    }
    CHECK("mean", sum / 4000, .5, .01)
    CHECK("not below 0", min(low, 0), 0, 0)
    CHECK("not above 1", max(high, 1), 1, 0)
    CHECK("spread", step(.35, high - low), 1, 0)
    color c = noise(point(s * 9 + .3, t * 9 + .4, .7));
    CHECK("independent channels", step(1e-6, abs(comp(c, 0) - comp(c, 1))), 1, 0)
    color g = noise(point(s * 9 + .3, t * 9 + .4, .7)) * color(1, 1, 1);
    CHECK("a product with a colour is grey", abs(comp(g, 0) - comp(g, 1)), 0, 1e-6)
    END_CHECKS
}
