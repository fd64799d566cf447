// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/shadeops.h"

#include "runtime/abi/sl_shadeop.h"
#include "runtime/base/module.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <mutex>
#include <sys/stat.h>
#include <utility>

namespace base {

namespace {

constexpr std::pair<char, sl_type> letters[] = {
    {'f', SL_TYPE_float},  {'c', SL_TYPE_color},  {'p', SL_TYPE_point}, {'v', SL_TYPE_vector},
    {'n', SL_TYPE_normal}, {'m', SL_TYPE_matrix}, {'s', SL_TYPE_string}};
constexpr std::pair<std::string_view, sl_type> words[] = {
    {"float", SL_TYPE_float},   {"color", SL_TYPE_color},   {"point", SL_TYPE_point},
    {"vector", SL_TYPE_vector}, {"normal", SL_TYPE_normal}, {"matrix", SL_TYPE_matrix},
    {"string", SL_TYPE_string}, {"void", SL_TYPE_void}};

bool type_of_letter(char letter, ShadeopArgument& to) {
    const auto lower = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    for (const auto& [known, type] : letters) {
        if (known == lower) {
            to = {type, lower != letter};
            return true;
        }
    }
    return false;
}

bool type_of_word(std::string_view word, sl_type& to) {
    for (const auto& [known, type] : words) {
        if (known == word) {
            to = type;
            return true;
        }
    }
    return false;
}

bool is_name_char(char c) {
    return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
}

// Words, and single characters that are none; "" at the end.
class Scanner {
public:
    explicit Scanner(std::string_view text) : rest_(text) {}
    std::string_view next() {
        while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) {
            rest_.remove_prefix(1);
        }
        std::size_t n = 0;
        while (n < rest_.size() && is_name_char(rest_[n])) {
            ++n;
        }
        const std::string_view word = rest_.substr(0, std::max<std::size_t>(n, 1));
        rest_.remove_prefix(word.size());
        return word;
    }

private:
    std::string_view rest_;
};

} // namespace

// init runs before the first call, whichever thread makes it.
struct Shadeop::Run {
    std::once_flag once;
    void* data = nullptr;
    bool was_started = false;
};

std::string Shadeop::signature_text() const {
    const auto letter = [](sl_type type, bool is_output) {
        const auto it = std::find_if(std::begin(letters), std::end(letters),
                                     [&](const auto& row) { return row.second == type; });
        return static_cast<char>(is_output ? std::toupper(it->first) : it->first);
    };
    std::string text = result_ == SL_TYPE_void ? "void" : std::string(1, letter(result_, false));
    text += '(';
    for (const ShadeopArgument& a : arguments_) {
        text += text.back() == '(' ? "" : ",";
        text += letter(a.type, a.is_output);
    }
    return text + ")";
}

bool Shadeop::parse(std::string_view text) {
    Scanner scan(text);
    const std::string_view result = scan.next();
    ShadeopArgument spec;
    if (result != "void") {
        if (result.size() != 1 || !type_of_letter(result[0], spec) || spec.is_output) {
            return false;
        }
        result_ = spec.type;
    }
    name_ = scan.next();
    if (name_.empty() || !is_name_char(name_[0]) || scan.next() != "(") {
        return false;
    }
    for (std::string_view word = scan.next(); word != ")"; word = scan.next()) {
        if (word == "," && !arguments_.empty()) {
            word = scan.next();
        }
        if (word.size() != 1 || !type_of_letter(word[0], spec)) {
            return false;
        }
        arguments_.push_back(spec);
    }
    return scan.next().empty();
}

// "float name (output color, point)": types are words, outputs are marked.
bool Shadeop::parse_classic(std::string_view text) {
    Scanner scan(text);
    if (!type_of_word(scan.next(), result_)) {
        return false;
    }
    name_ = scan.next();
    if (name_.empty() || scan.next() != "(") {
        return false;
    }
    for (std::string_view word = scan.next(); word != ")"; word = scan.next()) {
        ShadeopArgument spec;
        while (word == "," || word == "uniform" || word == "varying" || word == "output") {
            spec.is_output |= word == "output";
            word = scan.next();
        }
        if (!type_of_word(word, spec.type) || spec.type == SL_TYPE_void) {
            return false;
        }
        arguments_.push_back(spec);
    }
    return scan.next().empty();
}

void Shadeop::start() const {
    std::call_once(run_->once, [this] {
        run_->was_started = true;
        if (init_ == nullptr) {
            return;
        }
        run_->data = form_ == Form::Table
                         ? reinterpret_cast<void* (*)()>(init_)()
                         : reinterpret_cast<void* (*)(int, void*)>(init_)(0, nullptr);
    });
}

void Shadeop::call(std::span<void* const> values) const {
    start();
    if (form_ == Form::Table) {
        reinterpret_cast<void (*)(void*, void* const*)>(function_)(run_->data, values.data());
        return;
    }
    // The older form has a place for the result even where there is none.
    float nothing[3] = {};
    std::array<void*, SL_SHADEOP_MAX_ARGUMENTS + 1> all{};
    std::size_t n = 0;
    if (result_ == SL_TYPE_void) {
        all[n++] = nothing;
    }
    for (void* value : values) {
        all[n++] = value;
    }
    reinterpret_cast<int (*)(void*, int, void**)>(function_)(run_->data, static_cast<int>(n),
                                                             all.data());
}

struct ShadeopLibrary::Impl {
    std::mutex mutex;
    bool is_open = false;
    std::vector<Dso> dsos;
    std::map<std::string, std::vector<Shadeop>, std::less<>> functions;
    std::map<std::string, bool, std::less<>> looked_for; // names of the older form
    std::vector<std::string> problems;

    void open(const std::vector<std::string>& directories);
    void open_file(const std::string& path);
    void take_table(const Dso& dso, const sl_shadeop_table& table);
    void find_classic(std::string_view name);
    void take_classic(const Dso& dso, std::string_view name);
    void add(Shadeop shadeop, const Dso& dso);
};

ShadeopLibrary::ShadeopLibrary(std::vector<std::string> directories)
    : directories_(std::move(directories)), impl_(std::make_unique<Impl>()) {}

ShadeopLibrary::~ShadeopLibrary() {
    for (const auto& [name, overloads] : impl_->functions) {
        for (const Shadeop& f : overloads) {
            if (f.cleanup_ != nullptr && f.run_->was_started) {
                reinterpret_cast<void (*)(void*)>(f.cleanup_)(f.run_->data);
            }
        }
    }
}

namespace {

std::vector<std::string> files_of(const std::string& directory) {
    std::vector<std::string> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
        if (entry.path().extension() == ".so") {
            files.push_back(entry.path().string());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace

void ShadeopLibrary::Impl::open(const std::vector<std::string>& directories) {
    is_open = true;
    for (const std::string& directory : directories) {
        std::error_code error;
        if (!std::filesystem::is_directory(directory, error)) {
            problems.push_back(directory + " is no directory; no functions are taken from it");
        }
        for (const std::string& file : files_of(directory)) {
            open_file(file);
        }
    }
}

void ShadeopLibrary::Impl::open_file(const std::string& path) {
    Dso dso(path);
    if (!dso.error().empty()) {
        problems.push_back("cannot open " + path + ": " + dso.error());
        return;
    }
    if (const void* table = dso.symbol("sl_shadeops")) {
        take_table(dso, *static_cast<const sl_shadeop_table*>(table));
    }
    dsos.push_back(std::move(dso));
}

void ShadeopLibrary::Impl::add(Shadeop shadeop, const Dso& dso) {
    const auto num_outputs = std::count_if(shadeop.arguments_.begin(), shadeop.arguments_.end(),
                                           [](const ShadeopArgument& a) { return a.is_output; }) +
                             (shadeop.result_ == SL_TYPE_void ? 0 : 1);
    if (shadeop.arguments_.size() >= SL_SHADEOP_MAX_ARGUMENTS ||
        num_outputs > SL_SHADEOP_MAX_OUTPUTS) {
        problems.push_back(dso.path() + ": " + shadeop.name_ +
                           " has too many arguments or outputs");
        return;
    }
    shadeop.file_ = dso.path();
    shadeop.signature_ = shadeop.signature_text();
    shadeop.run_ = std::make_shared<Shadeop::Run>();
    auto& overloads = functions[shadeop.name_];
    if (overloads.empty() || overloads.front().file_ == dso.path()) {
        overloads.push_back(std::move(shadeop));
    }
}

void ShadeopLibrary::Impl::take_table(const Dso& dso, const sl_shadeop_table& table) {
    if (table.version != SL_SHADEOP_VERSION) {
        problems.push_back(dso.path() + ": its table has version " + std::to_string(table.version) +
                           ", not " + std::to_string(SL_SHADEOP_VERSION));
        return;
    }
    for (int i = 0; i < table.num_functions; ++i) {
        const sl_shadeop& row = table.functions[i];
        Shadeop shadeop;
        if (row.signature == nullptr || row.function == nullptr || !shadeop.parse(row.signature)) {
            problems.push_back(dso.path() + ": \"" +
                               (row.signature != nullptr ? row.signature : "") +
                               "\" is no signature of a function");
            continue;
        }
        shadeop.function_ = reinterpret_cast<void*>(row.function);
        shadeop.init_ = reinterpret_cast<void*>(row.init);
        shadeop.cleanup_ = reinterpret_cast<void*>(row.cleanup);
        add(std::move(shadeop), dso);
    }
}

namespace {

struct ClassicRow {
    const char* definition; // "float name_f (float)"; the name is that of the C function
    const char* init;       // names of C functions, or ""
    const char* shutdown;
};

void* symbol(const Dso& dso, const char* name) {
    return name != nullptr && name[0] != 0 ? dso.symbol(name) : nullptr;
}

} // namespace

void ShadeopLibrary::Impl::take_classic(const Dso& dso, std::string_view name) {
    const std::string table = std::string(name) + "_shadeops";
    const auto* row = static_cast<const ClassicRow*>(dso.symbol(table));
    for (; row != nullptr && row->definition != nullptr && row->definition[0] != 0; ++row) {
        Shadeop shadeop;
        const bool is_good = shadeop.parse_classic(row->definition);
        void* const function = is_good ? dso.symbol(shadeop.name_) : nullptr;
        if (function == nullptr) {
            problems.push_back(dso.path() + ": \"" + row->definition + "\" in " + table +
                               " is no declaration of a function that it has");
            continue;
        }
        shadeop.form_ = Shadeop::Form::Classic;
        shadeop.name_ = name;
        shadeop.function_ = function;
        shadeop.init_ = symbol(dso, row->init);
        shadeop.cleanup_ = symbol(dso, row->shutdown);
        add(std::move(shadeop), dso);
    }
}

// Tables of the older form cannot be listed, only asked for by name.
void ShadeopLibrary::Impl::find_classic(std::string_view name) {
    if (functions.find(name) != functions.end() ||
        !looked_for.emplace(std::string(name), true).second) {
        return;
    }
    for (const Dso& dso : dsos) {
        take_classic(dso, name);
    }
}

std::vector<const Shadeop*> ShadeopLibrary::find(std::string_view name) {
    std::vector<const Shadeop*> found;
    if (directories_.empty()) {
        return found;
    }
    const std::lock_guard lock(impl_->mutex);
    if (!impl_->is_open) {
        impl_->open(directories_);
    }
    impl_->find_classic(name);
    const auto it = impl_->functions.find(name);
    for (std::size_t i = 0; it != impl_->functions.end() && i < it->second.size(); ++i) {
        found.push_back(&it->second[i]); // lists do not change once they are there
    }
    return found;
}

const Shadeop* ShadeopLibrary::find(std::string_view name, std::string_view signature) {
    for (const Shadeop* shadeop : find(name)) {
        if (shadeop->signature() == signature) {
            return shadeop;
        }
    }
    return nullptr;
}

std::vector<std::string> ShadeopLibrary::take_problems() {
    const std::lock_guard lock(impl_->mutex);
    if (!directories_.empty() && !impl_->is_open) {
        impl_->open(directories_);
    }
    return std::exchange(impl_->problems, {});
}

std::string ShadeopLibrary::identity() const {
    std::string text;
    for (const std::string& directory : directories_) {
        for (const std::string& file : files_of(directory)) {
            struct stat status {};
            if (::stat(file.c_str(), &status) == 0) {
                text += file + " " + std::to_string(status.st_size) + " " +
                        std::to_string(status.st_mtim.tv_sec) + "." +
                        std::to_string(status.st_mtim.tv_nsec) + "\n";
            }
        }
    }
    return text;
}

} // namespace base
