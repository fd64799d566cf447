// SPDX-License-Identifier: Apache-2.0
/* 1989: points for directions and normals, words that became types later as names, a function without a result type. */
ramp ( float lo, hi, x ) { return clamp ((x-lo)/(hi-lo), 0, 1); }

surface
old_companion_style (
	float	Ka = .2, Kd=.8,
	    Ks = .4,	roughness = .05;
	color	specularcolor = 1 )
{
	point	normal, vector, PP, dir;
	float	matrix, ss;

	normal = normalize( faceforward( N, I ));
	vector = -normalize(I);
	PP = transform("object", P);
	dir = transform("world", PP + normal) - transform("world", PP);
	matrix = normal.vector;
	ss = ramp(.2, .7, matrix);
	setxcomp(PP, 0);
	if (xcomp(dir) < 0 && ycomp(dir) != 0) { ss = 1-ss; }
	else if (PP == point (0,0,0))
		ss = 0;
	Oi = Os;
	Ci = Os * (Cs * ss * (Ka*ambient() + Kd*diffuse(normal)) +
	      specularcolor * Ks * specular(normal, vector, roughness)) ;
}
