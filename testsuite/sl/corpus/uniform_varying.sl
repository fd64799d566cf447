// SPDX-License-Identifier: Apache-2.0
/* Corner cases of storage: uniform formals, varying arrays, uniform results of pure calls, nested uniform control. */
uniform float triangle_number(uniform float n)
{
    uniform float i, sum = 0;
    for (i = 1; i <= n; i += 1)
        sum += i;
    return sum;
}
float pick(varying float a[]; varying float k) { return a[k]; }
surface uniform_varying(uniform float n = 4; varying float w = .5; varying color tint = 1; float plain = 2; varying point Pref = 0;)
{
    uniform float total = triangle_number(n) + plain;
    varying float row[5];
    uniform float i;
    for (i = 0; i < 5; i += 1)
        row[i] = s * i + noise(t * i);
    float chosen = pick(row, s * 5) + pick(row, 2) + row[n] + row[-1] + row[99];
    uniform float list[3] = {1, 2, 3};
    float by_point = list[t * 3];
    uniform string mode = total > 5 ? "large" : "small";
    color c = mode == "large" ? tint * w : Cs;
    if (n > 2) {
        uniform float k = 0;
        while (k < n) {
            c *= 1 - .02 * k;
            k += 1;
            if (k > 3)
                break;
        }
    }
    Ci = Os * c * (by_point / 3) * (.5 + .1 * chosen) + length(Pref) * 0;
    Oi = Os;
}
