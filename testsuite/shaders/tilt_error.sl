// SPDX-License-Identifier: Apache-2.0
// For a plane z = 4 that tilt has raised by slope * u towards the eye: r error of P, g error of I for parallel rays, b
// s - s_by_u * u.
surface tilt_error(float slope = 0, s_by_u = 1;)
{
    Oi = 1;
    Ci = color(abs(zcomp(P) - (4 - slope * u)),
               abs(xcomp(I)) + abs(ycomp(I)) + abs(zcomp(I) - (4 - slope * u)), abs(s - s_by_u * u));
}
