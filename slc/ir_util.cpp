// SPDX-License-Identifier: Apache-2.0
#include "slc/ir_util.h"

namespace slc {

const OpInfo& op_info(Op op) {
    static constexpr OpInfo infos[] = {
#define SLC_OP(op, text, min_args, max_args, result, bodies)                                       \
    {text, min_args, max_args,                                                                     \
     (result) == 0   ? ResultUse::None                                                             \
     : (result) == 1 ? ResultUse::Always                                                           \
     : (result) == 2 ? ResultUse::Optional                                                         \
                     : ResultUse::Partial,                                                         \
     bodies},
#include "slc/ir_ops.def"
#undef SLC_OP
    };
    static_assert(std::size(infos) == static_cast<std::size_t>(Op::Gather) + 1);
    return infos[static_cast<std::size_t>(op)];
}

bool option_is_output(const Stmt& s, std::string_view name) {
    if (name.starts_with("send:")) {
        return false;
    }
    return s.op == Op::Gather ? name.find(':') != std::string_view::npos
                              : name.starts_with("light:");
}

} // namespace slc
