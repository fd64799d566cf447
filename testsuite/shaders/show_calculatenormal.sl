// SPDX-License-Identifier: Apache-2.0
// Shows how far calculatenormal() of the surface itself, and of the surface pushed along its normal by a constant,
// turns away from Ng: white where both agree with it, black where they point the other way.
surface show_calculatenormal(float push = .125;)
{
    normal n = normalize(calculatenormal(P));
    normal m = normalize(calculatenormal(P + push * normalize(Ng)));
    float agrees = min(n . normalize(Ng), m . normalize(Ng));
    Ci = max(agrees, 0);
    Oi = 1;
}
