// SPDX-License-Identifier: Apache-2.0
#include "tracer/shadeop_call.h"

#include "runtime/abi/sl_shadeop.h"
#include "runtime/base/shadeops.h"
#include "tracer/execution.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

namespace trace {

namespace {

const base::Shadeop* look_up(const Execution& execution, std::string_view function) {
    const std::size_t blank = function.find(' ');
    base::ShadeopLibrary* library = execution.frame.shadeops;
    const base::Shadeop* found =
        library != nullptr && blank != std::string_view::npos
            ? library->find(function.substr(0, blank), function.substr(blank + 1))
            : nullptr;
    if (found == nullptr) {
        report_shader(execution, base::Severity::Error, 0,
                      "needs the function \"" + std::string(function) +
                          "\" of a DSO, which no directory of -shadeops has; its results stay as "
                          "they are");
    }
    return found;
}

const base::Shadeop* find(const Execution& execution, sl_string function) {
    std::vector<ShadeopItem>& items = execution.thread->shadeops;
    const auto it = std::ranges::find(items, function, &ShadeopItem::function);
    if (it != items.end()) {
        return it->shadeop;
    }
    items.push_back({function, look_up(execution, function)});
    return items.back().shadeop;
}

// The values of one point, in the order of the signature.
class PointValues {
public:
    PointValues(const base::Shadeop& shadeop, std::span<const sl_value> outputs,
                std::span<const sl_value> inputs, std::uint32_t lanes)
        : lanes_(lanes) {
        std::size_t next_output = 0, next_input = 0;
        if (shadeop.result() != SL_TYPE_void) {
            values_[count_++] = {&outputs[next_output++], true};
        }
        for (const base::ShadeopArgument& a : shadeop.arguments()) {
            values_[count_++] = {a.is_output ? &outputs[next_output++] : &inputs[next_input++],
                                 a.is_output};
        }
        for (std::size_t i = 0; i < count_; ++i) {
            const bool is_text = values_[i].value->type == SL_TYPE_string;
            pointers_[i] = is_text ? static_cast<void*>(&texts_[i]) : floats_[i].data();
        }
    }

    void take(std::uint32_t lane) {
        for (std::size_t i = 0; i < count_; ++i) {
            const sl_value& v = *values_[i].value;
            if (v.type == SL_TYPE_string) {
                const char* text = static_cast<const sl_string*>(v.data)[v.varying != 0 ? lane : 0];
                texts_[i] = {text != nullptr ? text : "", 0};
                continue;
            }
            const auto* from = static_cast<const float*>(v.data);
            for (std::uint32_t k = 0; k < components(v); ++k) {
                floats_[i][k] = v.varying != 0 ? from[k * lanes_ + lane] : from[k];
            }
        }
    }

    [[nodiscard]] std::span<void* const> pointers() const { return {pointers_.data(), count_}; }

    void give(std::uint32_t lane, rt::StringTable& strings) {
        for (std::size_t i = 0; i < count_; ++i) {
            const sl_value& v = *values_[i].value;
            if (!values_[i].is_output) {
                continue;
            }
            if (v.type == SL_TYPE_string) {
                const char* text = texts_[i].text;
                static_cast<sl_string*>(v.data)[v.varying != 0 ? lane : 0] =
                    strings.intern(text != nullptr ? text : "");
                continue;
            }
            auto* to = static_cast<float*>(v.data);
            for (std::uint32_t k = 0; k < components(v); ++k) {
                to[v.varying != 0 ? k * lanes_ + lane : k] = floats_[i][k];
            }
        }
    }

private:
    static std::uint32_t components(const sl_value& v) {
        return static_cast<std::uint32_t>(rt::components_of(v.type));
    }

    // What older DSOs expect behind the pointer: their text with its length.
    struct Text {
        const char* text = nullptr;
        int length = 0;
    };
    struct Item {
        const sl_value* value = nullptr;
        bool is_output = false;
    };
    static constexpr std::size_t most = SL_SHADEOP_MAX_ARGUMENTS + 1;
    std::uint32_t lanes_;
    std::size_t count_ = 0;
    std::array<Item, most> values_{};
    std::array<void*, most> pointers_{};
    std::array<Text, most> texts_{};
    std::array<std::array<float, 16>, most> floats_{};
};

bool fits(const base::Shadeop& shadeop, std::size_t num_outputs, std::size_t num_inputs) {
    const auto arguments = shadeop.arguments();
    const auto set = static_cast<std::size_t>(
        std::ranges::count_if(arguments, &base::ShadeopArgument::is_output));
    return set + (shadeop.result() != SL_TYPE_void ? 1 : 0) == num_outputs &&
           arguments.size() - set == num_inputs;
}

} // namespace

void call_shadeop(const Execution& execution, sl_string function, std::uint32_t mask,
                  std::span<const sl_value> outputs, std::span<const sl_value> inputs) {
    if (execution.thread == nullptr) { // defaults of parameters: the compiler refuses them
        return;
    }
    const base::Shadeop* shadeop = find(execution, function);
    if (shadeop == nullptr || !fits(*shadeop, outputs.size(), inputs.size())) {
        return;
    }
    PointValues values(*shadeop, outputs, inputs, execution.lanes());
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        values.take(lane);
        shadeop->call(values.pointers());
        values.give(lane, execution.frame.strings);
    }
}

} // namespace trace
