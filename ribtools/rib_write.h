// SPDX-License-Identifier: Apache-2.0
// Requests to RIB, driven by the args column of ri_requests.def: the parser's way backwards.
//
// In: requests in order, as ParseMode::Keep makes them: parameter names are whole tokens, colors
// have as many samples as their writer meant (later the C binding will hand on its calls in this
// form). Out: a stream that, read again, gives the same requests to the last bit of every number.
#pragma once

#include "ribtools/request.h"
#include "ribtools/rib_encode.h"

#include <string_view>

namespace rib {

enum class RibForm : std::uint8_t { Text, Binary };

struct WriteOptions {
    RibForm form = RibForm::Text;
    int indent = 0; // text: blanks per open block
};

class Writer {
public:
    // The sink must outlive the writer.
    Writer(ByteSink& sink, WriteOptions options);

    // Of the table or outside it (Request::values). Which vector of a parameter or argument holds
    // something says what it is; its declaration is not looked at.
    void request(const Request& request);

    // What RiArchiveRecord writes, by kind: "comment" and "structure" become comments of one line
    // per line of text, "verbatim" stands as it is. trailing: stays on the line of the request
    // before.
    void record(std::string_view kind, std::string_view text, bool trailing = false);

    // Everything goes to the sink, whose finish() is the caller's.
    void flush() { encoder_->flush(); }

    // Numbers that were not finite and had to be replaced.
    [[nodiscard]] std::uint64_t num_not_finite() const { return encoder_->num_not_finite(); }

private:
    void arguments(const Request& request, std::string_view codes);
    void argument(char code, const Arg& arg);
    void handle(const Arg& arg);
    void parameter(const Param& param);
    void loose(const LooseValue& value);

    std::unique_ptr<Encoder> encoder_;
    int depth_ = 0;
};

} // namespace rib
