// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_write.h"

#include "ribtools/rib_chars.h"

#include <algorithm>
#include <charconv>

namespace rib {

namespace {

// How a request changes the depth of blocks: what it opens counts behind it, what it closes before.
struct Nesting {
    int before = 0, after = 0;
};

Nesting nesting_of(std::string_view name) {
    if (name.ends_with("Begin")) {
        return {0, 1};
    }
    if (name.ends_with("End")) {
        return {-1, 0};
    }
    return name == "Else" || name == "ElseIf" ? Nesting{-1, 1} : Nesting{};
}

// An integer as the reader would spell it as a handle: "7" but not "07" or "7.0".
bool is_plain_integer(std::string_view text, std::int32_t& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() &&
           text == std::to_string(value);
}

} // namespace

Writer::Writer(ByteSink& sink, WriteOptions options)
    : encoder_(options.form == RibForm::Binary ? binary_encoder(sink)
                                               : text_encoder(sink, options.indent)) {}

void Writer::request(const Request& request) {
    const bool is_loose =
        request.id == RequestId::Unknown || row(request.id).kind == RequestKind::Skipped;
    const std::string_view name = is_loose ? request.name : row(request.id).name;
    const Nesting nesting = nesting_of(name);
    depth_ = std::max(0, depth_ + nesting.before);
    encoder_->begin(name, depth_);
    depth_ += nesting.after;
    if (is_loose) {
        for (const LooseValue& value : request.values) {
            loose(value);
        }
    } else {
        arguments(request, row(request.id).args);
        for (const Param& param : request.params.params) {
            parameter(param);
        }
    }
    encoder_->end();
}

// Optional arguments are written if they are given; see the head of ri_requests.def.
void Writer::arguments(const Request& request, std::string_view codes) {
    std::size_t index = 0;
    bool in_group = false;
    for (std::size_t k = 0; k < codes.size(); ++k) {
        const char code = codes[k];
        if (code == '(' || code == ')') {
            in_group = code == '(';
        } else if (code != '?') {
            const Arg& arg = request.args[index++];
            const bool optional = in_group || (k + 1 < codes.size() && codes[k + 1] == '?');
            if (arg.given || !optional) {
                argument(code, arg);
            }
        }
    }
}

void Writer::argument(char code, const Arg& arg) {
    switch (code) {
    case 'i':
        encoder_->number(arg.ints.empty() ? 0 : arg.ints.front());
        break;
    case 'f':
        encoder_->number(arg.numbers.empty() ? 0 : arg.numbers.front());
        break;
    case 's':
        encoder_->string(arg.strings.empty() ? std::string_view() : arg.strings.front());
        break;
    case 'h':
        handle(arg);
        break;
    case 'v':
        if (!arg.strings.empty() && is_run(arg.strings.front())) { // "3.03.1", which is no number
            encoder_->bare(arg.strings.front());
        } else {
            encoder_->number(arg.numbers.empty() ? 0 : arg.numbers.front());
        }
        break;
    case 'B':
        if (!arg.strings.empty()) {
            encoder_->string(arg.strings.front());
            break;
        }
        [[fallthrough]];
    case 'c':
    case 'b':
    case 'm':
        encoder_->doubles(arg.numbers);
        break;
    case 'I':
        encoder_->ints(arg.ints);
        break;
    case 'F':
        encoder_->floats(arg.floats);
        break;
    case 'S':
        encoder_->strings(arg.strings);
        break;
    default:
        break;
    }
}

// Handles are text inside; one that looks like a number is written as one.
void Writer::handle(const Arg& arg) {
    const std::string_view text = arg.strings.empty() ? std::string_view() : arg.strings.front();
    std::int32_t number = 0;
    if (is_plain_integer(text, number)) {
        encoder_->number(number);
    } else {
        encoder_->string(text);
    }
}

void Writer::parameter(const Param& param) {
    encoder_->string(param.name);
    if (!param.strings.empty()) {
        encoder_->strings(param.strings);
    } else if (!param.ints.empty()) {
        encoder_->ints(param.ints);
    } else {
        encoder_->floats(param.floats);
    }
}

void Writer::loose(const LooseValue& value) {
    if (value.is_array && !value.strings.empty()) {
        encoder_->strings(value.strings);
    } else if (value.is_array) {
        encoder_->doubles(value.numbers);
    } else if (!value.strings.empty()) {
        encoder_->string(value.strings.front());
    } else {
        encoder_->number(value.numbers.empty() ? 0 : value.numbers.front());
    }
}

void Writer::record(std::string_view kind, std::string_view text, bool trailing) {
    if (kind == "verbatim") {
        encoder_->verbatim(text);
        return;
    }
    const std::string_view marks = kind == "structure" ? "##" : "#";
    std::size_t begin = 0;
    do {
        const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        encoder_->comment(std::string(marks).append(text.substr(begin, end - begin)), depth_,
                          trailing);
        begin = end + 1;
    } while (begin < text.size());
}

} // namespace rib
