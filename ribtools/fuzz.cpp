// SPDX-License-Identifier: Apache-2.0
#include "ribtools/fuzz.h"

#include "ribtools/rib_convert.h"

#include <cstdio>
#include <cstdlib>

namespace rib_fuzz {

namespace {

class NoBackend final : public rib::Backend {
public:
    bool render(std::unique_ptr<rib::Scene>) override { return true; }
    bool make_texture(const rib::TextureRequest&) override { return true; }
};

std::string convert(const std::string& stream, rib::RibForm form) {
    std::string out;
    base::Diag diag;
    diag.set_handler(base::ErrorHandler::Ignore);
    const auto sink = rib::memory_sink(out);
    rib::Writer writer(*sink, {form, 0});
    rib::Converter converter(writer, diag, {});
    (void)converter.convert_text(stream, "fuzz");
    writer.flush();
    return out;
}

} // namespace

void read_and_convert(const std::string& stream) {
    {
        base::Diag diag;
        diag.set_threshold(base::Severity::Severe);
        NoBackend backend;
        rib::Reader reader(backend, diag, {});
        (void)reader.read_text(stream, "fuzz");
    }
    const std::string text = convert(stream, rib::RibForm::Text);
    if (convert(text, rib::RibForm::Text) != text ||
        convert(convert(text, rib::RibForm::Binary), rib::RibForm::Text) != text) {
        std::fputs("what was written is not what is read\n", stderr);
        std::abort();
    }
}

} // namespace rib_fuzz
