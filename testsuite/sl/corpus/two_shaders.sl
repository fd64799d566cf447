// SPDX-License-Identifier: Apache-2.0
/* Two shaders and a function in one file; names differ from the file's. */
float shared_gain(float x) { return x * 2; }
surface first_of_two(float k = shared_gain(1)) { Ci = Cs * k; Oi = Os; }
light second_of_two(float k = 1; color c = color "YIQ" (1, 0, 0)) { Cl = shared_gain(k) * c; }
transformation third_of_two(float amount = 1) { P += amount * vector (0, 0, 1); }
