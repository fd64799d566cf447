/* SPDX-License-Identifier: Apache-2.0
 * Message functions and queries of the ray's and shader's state, one text per world.
 */

F FN(message_atmosphere)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_atmosphere, name, out);
}
F FN(message_displacement)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_displacement, name, out);
}
F FN(message_lightsource)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_lightsource, name, out);
}
F FN(message_surface)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_surface, name, out);
}
F FN(message_incident)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_incident, name, out);
}
F FN(message_opposite)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_opposite, name, out);
}
F FN(message_attribute)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_attribute, name, out);
}
F FN(message_option)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_option, name, out);
}
F FN(message_rendererinfo)(CALL, sl_string name, const sl_value* out) {
    return FN(ask_)(PASS, SL_MESSAGE_rendererinfo, name, out);
}

S FN(shadername)(CALL) {
    return FN(of_string_)(call->services->shader_name(call->engine, NULL));
}
S FN(shadername_of)(CALL, sl_string type) {
    return FN(of_string_)(name_of(call, type));
}

F FN(raylevel)(CALL) {
    return K((float)call->services->raylevel(call->engine));
}
F FN(isshadowray)(CALL) {
    return K(call->services->ray_kind(call->engine) == SL_RAY_shadow ? 1 : 0);
}
F FN(isindirectray)(CALL) {
    return K(call->services->ray_kind(call->engine) == SL_RAY_diffuse ? 1 : 0);
}
S FN(raylabel)(CALL) {
    return FN(label_)(PASS);
}
