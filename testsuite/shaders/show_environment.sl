// SPDX-License-Identifier: Apache-2.0
/* Shows what an environment holds along the normal, in world space. */
surface show_environment(string name = ""; float blur = 0;)
{
    Oi = 1;
    Ci = environment(name, ntransform("world", normalize(N)), "blur", blur);
}
