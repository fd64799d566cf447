// SPDX-License-Identifier: Apache-2.0
// warns: parameter '__nonspecular' is assigned a varying value
/* A light with everything on it: superelliptic cross-section, barn shape, distance falloff, slide, noise, shadow map,
 * categories and computed __nonspecular. Nested helper functions, string switches, output parameters. */
float superellipse_clip(point Q; float a, b, A, B, roundness)
{
    float result = 0;
    float x = abs(xcomp(Q)), y = abs(ycomp(Q));
    if (roundness < 1.0e-6) {
        result = 1 - (1 - smoothstep(a, A, x)) * (1 - smoothstep(b, B, y));
    } else {
        float re = 2 / roundness;
        float sqr_root(float v, k) { return pow(v, k); }
        float q = a * b * pow(sqr_root(b * x, re) + sqr_root(a * y, re), -1 / re);
        float r = A * B * pow(sqr_root(B * x, re) + sqr_root(A * y, re), -1 / re);
        result = smoothstep(q, r, 1);
    }
    return result;
}

float volume_shape(point PL; string lighttype; vector axis; float znear, zfar, nearedge, faredge, falloff, falloffdist,
                   maxintensity, shearx, sheary, width, height, hedge, wedge, roundness, beamdistribution)
{
    float Plength = length(PL);
    float Pz = lighttype == "spot" || lighttype == "arealight" ? zcomp(PL) : Plength;
    float atten = 1;
    atten *= smoothstep(znear - nearedge, znear, Pz);
    atten *= 1 - smoothstep(zfar, zfar + faredge, Pz);
    if (falloff != 0) {
        if (Plength > falloffdist) {
            atten *= pow(falloffdist / Plength, falloff);
        } else {
            float s = log(1 / maxintensity);
            float beta = -falloff / s;
            atten *= (maxintensity * exp(s * pow(Plength / falloffdist, beta)));
        }
    }
    if (lighttype != "omni" && beamdistribution > 0)
        atten *= pow(zcomp(normalize(vector PL)), beamdistribution);
    if (lighttype == "spot")
        atten *= 1 - superellipse_clip(PL / Pz - point (shearx, sheary, 0), width, height, width + wedge,
                                       height + hedge, roundness);
    return atten;
}

light uber_light(
    string lighttype = "spot";
    float intensity = 1;
    color lightcolor = color (1, 1, 1), filter = color (1, 1, 1);
    float cuton = .01, cutoff = 1.0e6, nearedge = 0, faredge = 0;
    float falloff = 0, falloffdist = 1, maxintensity = 1;
    float parallelrays = 0;
    float shearx = 0, sheary = 0;
    float width = .6, height = .6, wedge = .1, hedge = .1, roundness = 1, beamdistribution = 0;
    string slidename = "";
    float noiseamp = 0, noisefreq = 4;
    vector noiseoffset = 0;
    string shadowmap = "";
    float shadowblur = .01, shadowbias = .01, shadownsamps = 16;
    color shadowcolor = 0;
    string __category = "uber,key";
    output float __nonspecular = 0;
    output float __nondiffuse = 0;
    output float __foglight = 1;)
{
    point PL = transform("shader", Ps);
    vector axis = normalize(vtransform("shader", "current", vector (0, 0, 1)));
    point from = point "shader" (0, 0, 0);
    uniform float angle;
    if (lighttype == "spot") {
        uniform float maxradius = 1.4142136 * max(height + hedge + abs(sheary), width + wedge + abs(shearx));
        angle = atan(maxradius);
    } else if (lighttype == "arealight") {
        angle = PI / 2;
    } else {
        angle = PI;
    }
    illuminate (from, axis, angle)
    {
        float atten = lighttype == "omni" ? 1 : 1;
        atten = superellipse_clip(point (0, 0, 0), 1, 1, 2, 2, 1) + 1;
        atten *= volume_shape(PL, lighttype, axis, cuton, cutoff, nearedge, faredge, falloff, falloffdist, maxintensity,
                              shearx, sheary, width, height, hedge, wedge, roundness, 0);
        color lcol = lightcolor;
        if (slidename != "") {
            point Pslide = PL / point (width + wedge, height + hedge, 1);
            float zslide = zcomp(Pslide);
            float xslide = .5 + .5 * xcomp(Pslide) / zslide, yslide = .5 - .5 * ycomp(Pslide) / zslide;
            lcol = lcol * color texture(slidename, xslide, yslide);
        }
        if (noiseamp > 0)
            atten *= 1 - noiseamp * float noise(noisefreq * (PL + noiseoffset));
        float unoccluded = 1;
        if (shadowmap != "")
            unoccluded *= 1 - shadow(shadowmap, Ps, "blur", shadowblur, "samples", shadownsamps, "bias", shadowbias);
        lcol = mix(shadowcolor, lcol, unoccluded);
        if (parallelrays != 0)
            L = axis * length(Ps - from);
        __nonspecular = 1 - unoccluded * (1 - __nonspecular);
        Cl = (atten * intensity) * lcol * filter;
    }
}
