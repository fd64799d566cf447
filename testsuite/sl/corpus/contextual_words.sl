// SPDX-License-Identifier: Apache-2.0
/* Words that are reserved only where the grammar needs them. */
surface contextual_words(float distance = 1, diffuse = .5, specular = .25; color light = 1; float step = .1;
                         float min = 0, max = 1; vector incident = 0; string option = "a", attribute = "b";)
{
    color surface_color = light;
    float round = 0, texture = 2;
    float found = surface("Kd", round);
    float moved = displacement("amplitude", texture);
    if (found + moved > 0)
        surface_color *= round;
    vector opposite = reflect(incident, N);
    Ci = diffuse * surface_color * diffuse(normalize(N)) + specular * specular(normalize(N), opposite, step);
    Ci = clamp(Ci, color min, color max) * distance(P, E) / distance;
    if (option == attribute)
        Ci = 0;
    Oi = 1;
}
