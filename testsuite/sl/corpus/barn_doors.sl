// SPDX-License-Identifier: Apache-2.0
/* A spot behind four doors whose edges are soft; doors given by arrays, cut in a loop. */
light barn_doors(float intensity = 10; color lightcolor = 1; point from = point "shader" (0, 0, 0);
                 point to = point "shader" (0, 0, 1); float coneangle = radians(40), edge = .05;
                 float door[4] = {.4, .4, .2, .3}; varying output float __nondiffuse = 0;)
{
    vector axis = normalize(to - from);
    illuminate (from, axis, coneangle) {
        point Q = transform("shader", Ps);
        float x = xcomp(Q) / zcomp(Q), y = ycomp(Q) / zcomp(Q);
        float across[4];
        across[0] = x;
        across[1] = -x;
        across[2] = y;
        across[3] = -y;
        uniform float i;
        float open = 1;
        for (i = 0; i < 4; i += 1)
            open *= 1 - smoothstep(door[i] - edge, door[i] + edge, across[i]);
        Cl = intensity * lightcolor * open / (L . L);
    }
}
