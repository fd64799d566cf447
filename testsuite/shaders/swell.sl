// SPDX-License-Identifier: Apache-2.0
// Moves a sphere's surface outward: it is a larger sphere.
displacement swell(float by = .25;)
{
    P += by * normalize(N);
}
