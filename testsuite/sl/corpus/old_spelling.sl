// SPDX-License-Identifier: Apache-2.0
/* Points for colours' sake, commas before types, stray semicolons, chained assignments, odd spacing. */
float blendit (float a, float b, float k) { return a*(1.-k)+b*k; };
;
surface old_spelling ( ;; float Ka=1.,Kd=0.5f;; color c = color(1,.5,.25) ;
    point light_pos = (0,0,0), axis = point "shader" (0,1,0);; )
{
    point PP,NN,V; float a,b=.5 , c2 ;;
    NN=normalize(faceforward(N,I)); V=normalize(-I);
    PP = transform("shader",P) - transform("shader", point 0);
    a = c2 = xcomp(PP)*.5;
    setzcomp(PP, ycomp(PP)); setycomp (PP,0) ;
    if( a<b ) { ; } else a=b ;
    Ci = Oi = 0;
    Oi = Os ; Ci = Os * ( c*Ka*ambient() + blendit(Kd,a,b)*Cs*diffuse(NN) ) * length ( PP + NN + V - light_pos ) ;
}
