// SPDX-License-Identifier: Apache-2.0
// An output that is not a number where u < .5: infinity less infinity, out of sight of constant folding.
surface show_nan(output varying float bad = 0;)
{
    float huge = 1e30 * (1 + u);
    float more = huge * huge;
    Oi = 1;
    Ci = Cs;
    bad = (u < .5) ? more - more : 1;
}
