// SPDX-License-Identifier: Apache-2.0
// Raises the surface along its normal by slope * u and leaves the normal to the renderer.
displacement tilt(float slope = 1; output varying float height = 0;)
{
    height = slope * u;
    P += height * normalize(N);
}
