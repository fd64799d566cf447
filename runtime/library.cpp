// SPDX-License-Identifier: Apache-2.0
// Shaders of a run. In: names with the search path that held where they were named. Out: loaded
// objects. Looking for a name is cheap and done at once, in the order of the calls; loading and
// compiling is a job per file, done once, in the background if it was announced. Messages wait in
// the record they belong to until somebody asks for the shader: their order is that of find().
#include "runtime/base/file.h"
#include "runtime/base/work_queue.h"
#include "runtime/shader.h"
#include "runtime/shader_finder.h"
#include "sl_fingerprint.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>

namespace rt {

namespace {

constexpr const char* type_names[] = {"surface", "displacement", "light",
                                      "volume",  "imager",       "transformation"};

std::string shader_type_text(int type) {
    return type >= 0 && type <= SL_SHADER_transformation ? type_names[type] : "unknown";
}

// Each directory once, the first time counts.
std::vector<std::string> whole_path(const ShaderLibrary::Config& config,
                                    ShaderLibrary::Path between) {
    std::vector<std::string> path;
    for (const ShaderLibrary::Path part : {ShaderLibrary::Path(config.path_first), between,
                                           ShaderLibrary::Path(config.search_path)}) {
        for (const std::string& directory : part) {
            if (std::find(path.begin(), path.end(), directory) == path.end()) {
                path.push_back(directory);
            }
        }
    }
    return path;
}

// Adds its life time to a sum of nanoseconds.
class Stopwatch {
public:
    explicit Stopwatch(std::atomic<std::uint64_t>& sum_ns)
        : sum_ns_(sum_ns), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() {
        sum_ns_ += static_cast<std::uint64_t>(
            std::chrono::nanoseconds(std::chrono::steady_clock::now() - start_).count());
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    std::atomic<std::uint64_t>& sum_ns_;
    std::chrono::steady_clock::time_point start_;
};

} // namespace

struct ShaderLibrary::Impl {
    // Messages of work that was done before its turn.
    struct Said {
        base::Diag diag{base::Diag::Deferred::Yes};
    };

    // One file (or member of a package) to be loaded or compiled.
    struct Job : Said {
        ShaderPlace place;
        base::SourcePos pos; // in diag
        bool is_started = false, is_done = false;
        const ShaderObject* object = nullptr;
    };

    // A name on a path, and the job it led to; null: nothing found.
    struct Name : Said {
        Job* job = nullptr;
    };

    Impl(Config config_, StringTable& strings_, base::Diag& diag_)
        : config(std::move(config_)), strings(strings_), diag(diag_),
          cache(config.cache_dir, config.cache_bytes), finder(config.trusted, config.trust_all),
          cancelled([this] { return is_ending || (config.interrupted && config.interrupted()); }),
          queue(std::max(config.num_threads, 1)) {}

    ~Impl() { stop(); }

    void stop() {
        is_ending = true;
        queue.stop();
        const std::lock_guard lock(mutex);
        for (auto& [file, job] : jobs) { // those that had not begun never will
            job.is_done = true;
        }
        job_done.notify_all();
    }

    const Config config;
    StringTable& strings;
    base::Diag& diag;
    ShaderCache cache;
    std::mutex mutex; // of all below but the queue
    std::condition_variable job_done;
    ShaderFinder finder;
    std::map<std::string, std::unique_ptr<ShaderObject>, std::less<>> by_file;
    std::vector<std::unique_ptr<ShaderObject>> nameless;             // linked in, or in memory
    std::map<std::string, const ShaderObject*, std::less<>> adopted; // by name of the shader
    std::map<std::string, const ShaderObject*, std::less<>> special; // made in this run, by key
    std::map<std::string, Name, std::less<>> names;
    std::map<std::string, Job, std::less<>> jobs; // by file
    std::atomic<bool> is_ending{false};
    struct Counts {
        std::atomic<std::uint64_t> objects{0}, cache_hits{0}, cache_misses{0}, compiled{0},
            compiled_special{0};
        std::atomic<std::uint64_t> search_ns{0}, compile_ns{0}, special_ns{0}, load_ns{0};
    } counts;
    const Cancelled cancelled;
    base::WorkQueue queue; // last: its threads use the rest

    // --- opening, on any thread, without the mutex

    const ShaderObject* keep(std::string key, std::unique_ptr<ShaderObject> object) {
        ++counts.objects;
        const std::lock_guard lock(mutex);
        if (key.empty()) {
            return nameless.emplace_back(std::move(object)).get();
        }
        return by_file.emplace(std::move(key), std::move(object)).first->second.get();
    }

    const ShaderObject* open(const std::string& path, std::string& why) {
        {
            const std::lock_guard lock(mutex);
            if (const auto it = by_file.find(path); it != by_file.end()) {
                return it->second.get();
            }
        }
        const Stopwatch watch(counts.load_ns);
        auto object = ShaderObject::open(path, strings, why);
        return object ? keep(path, std::move(object)) : nullptr;
    }

    const ShaderObject* open_bytes(std::string_view bytes, std::string& why) {
        const Stopwatch watch(counts.load_ns);
        auto object = ShaderObject::open_bytes(bytes, strings, why);
        return object ? keep({}, std::move(object)) : nullptr;
    }

    const ShaderObject* open_member(const ShaderPlace& place, std::string& why) {
        const auto bytes = place.package->read(place.member);
        if (!bytes) {
            why = "cannot be read";
            return nullptr;
        }
        return open_bytes(*bytes, why);
    }

    const ShaderObject* open_cached(const std::string& key) {
        const std::string path = cache.object_path(key);
        std::string why; // a damaged entry is replaced
        const ShaderObject* object = cache.is_on() ? open(path, why) : nullptr;
        if (object) {
            ++counts.cache_hits;
            ShaderCache::mark_used(path);
        }
        return object;
    }

    const ShaderObject* compile(const std::string& source, const std::string& key, Job& job) {
        ++counts.cache_misses;
        const auto bytes = [&] {
            const Stopwatch watch(counts.compile_ns);
            return config.compile(source, job.diag, cancelled);
        }();
        if (!bytes) {
            return nullptr;
        }
        ++counts.compiled;
        std::string why = cache.is_on() ? cache.store(key, *bytes) : "off";
        if (!why.empty() && cache.is_on()) {
            job.diag.report_once("shader cache", base::Severity::Warning, base::Code::System, {},
                                 "shader cache " + cache.directory() +
                                     " cannot be written; shaders are compiled for this run only");
        }
        const ShaderObject* object =
            why.empty() ? open(cache.object_path(key), why) : open_bytes(*bytes, why);
        if (!object) { // evicted or damaged meanwhile
            object = open_bytes(*bytes, why);
        }
        if (!object) {
            job.diag.report(base::Severity::Error, base::Code::NoShader, {},
                            "the object just compiled from " + source + " " + why);
        }
        return object;
    }

    const ShaderObject* open_source(const std::string& source, Job& job) {
        if (!config.compile || !config.cache_key) {
            job.diag.report_once("no compiler " + source, base::Severity::Error,
                                 base::Code::NoShader, {},
                                 source + " is not compiled, and this program cannot compile it");
            return nullptr;
        }
        const auto key = [&] {
            const Stopwatch watch(counts.search_ns);
            return config.cache_key(source, job.diag, cancelled);
        }();
        if (!key) {
            return nullptr;
        }
        if (const ShaderObject* object = open_cached(*key)) {
            return object;
        }
        if (!cache.is_on()) {
            return compile(source, *key, job);
        }
        const base::FileLock lock = cache.lock(*key, cancelled);
        const ShaderObject* object = open_cached(*key); // whoever held the lock has made it
        return object || cancelled() ? object : compile(source, *key, job);
    }

    const ShaderObject* open_place(Job& job) {
        const ShaderPlace& place = job.place;
        if (place.object.empty() && !place.package) {
            return open_source(place.source, job);
        }
        std::string why;
        const std::string what =
            place.package ? place.package->path() + "(" + place.member + ")" : place.object;
        const ShaderObject* object =
            place.package ? open_member(place, why) : open(place.object, why);
        if (object) {
            return object;
        }
        const bool rescue = !place.source.empty() && config.compile;
        job.diag.report(
            rescue ? base::Severity::Warning : base::Severity::Error, base::Code::NoShader, job.pos,
            what + " " + why + (rescue ? "; " + place.source + " is compiled instead" : ""));
        return rescue ? open_source(place.source, job) : nullptr;
    }

    void run(Job& job) {
        {
            const std::lock_guard lock(mutex);
            if (job.is_started) {
                return;
            }
            job.is_started = true;
        }
        const ShaderObject* object = cancelled() ? nullptr : open_place(job);
        const std::lock_guard lock(mutex);
        job.object = object;
        job.is_done = true;
        job_done.notify_all();
    }

    // --- special shaders, on any thread, without the mutex

    const ShaderObject* known_special(const std::string& key) {
        {
            const std::lock_guard lock(mutex);
            if (const auto it = special.find(key); it != special.end()) {
                return it->second;
            }
        }
        const std::string path = cache.object_path(key);
        std::string why; // most have never been made
        const ShaderObject* object = cache.is_on() ? open(path, why) : nullptr;
        if (object) {
            ShaderCache::mark_used(path);
        }
        return object;
    }

    const ShaderObject* make_special(const SpecialShader& order, const Cancelled& stop) {
        base::Diag unheard(base::Diag::Deferred::Yes);
        const auto ending = [&] { return cancelled() || (stop && stop()); };
        const auto bytes = [&] {
            const Stopwatch watch(counts.special_ns);
            return order.compile(unheard, ending);
        }();
        if (!bytes) {
            return nullptr;
        }
        ++counts.compiled_special;
        if (cache.is_on()) {
            (void)cache.store(order.key, *bytes); // kept or not, it is used
        }
        std::string why;
        const ShaderObject* object = open_bytes(*bytes, why);
        const std::lock_guard lock(mutex);
        return object ? special.emplace(order.key, object).first->second : nullptr;
    }

    // --- names, with the mutex held

    Job* job_for(ShaderPlace place, const Name& name, base::SourcePos pos, bool& is_new) {
        std::string key = place.package           ? place.package->path() + "\n" + place.member
                          : !place.object.empty() ? place.object
                                                  : place.source;
        const auto [it, inserted] = jobs.try_emplace(std::move(key));
        is_new = inserted;
        Job& job = it->second;
        if (is_new) {
            job.place = std::move(place);
            job.pos = job.diag.place_from(name.diag, pos);
        }
        return &job;
    }

    // The record of a name; new_job is a job that nobody has been given yet.
    Name& look_up(const std::string& stem, base::SourcePos pos, Path path, Job*& new_job) {
        std::string key = stem;
        for (const std::string& directory : path) {
            key += '\n';
            key += directory;
        }
        const auto [it, is_new] = names.try_emplace(std::move(key));
        Name& name = it->second;
        if (is_new) {
            const base::SourcePos here = name.diag.place_from(diag, pos);
            const Stopwatch watch(counts.search_ns);
            ShaderPlace place = finder.find(stem, whole_path(config, path), here, name.diag);
            bool is_new_job = false;
            name.job =
                place.is_empty() ? nullptr : job_for(std::move(place), name, here, is_new_job);
            new_job = is_new_job ? name.job : nullptr;
        }
        return name;
    }
};

ShaderLibrary::ShaderLibrary(Config config, StringTable& strings, base::Diag& diag)
    : impl_(new Impl(std::move(config), strings, diag)), strings_(strings) {}

ShaderLibrary::~ShaderLibrary() = default;

const ShaderObject* ShaderLibrary::find(std::string_view name, sl_shader_type wanted,
                                        base::SourcePos pos, Path path) {
    const ShaderObject* found = find_any(name, pos, path);
    if (found && found->object().type != wanted) {
        const std::string stem = shader_stem(name);
        impl_->diag.report_once("shader type " + stem + shader_type_text(wanted),
                                base::Severity::Error, base::Code::NoShader, pos,
                                "shader \"" + stem + "\" is a " +
                                    shader_type_text(found->object().type) + " shader, not a " +
                                    shader_type_text(wanted) + " shader");
        return nullptr;
    }
    return found;
}

const ShaderObject* ShaderLibrary::find_any(std::string_view name, base::SourcePos pos, Path path) {
    const std::string stem = shader_stem(name);
    std::unique_lock lock(impl_->mutex);
    if (const auto it = impl_->adopted.find(stem); it != impl_->adopted.end()) {
        return it->second;
    }
    Impl::Job* new_job = nullptr;
    Impl::Name& record = impl_->look_up(stem, pos, path, new_job);
    if (new_job) {
        lock.unlock();
        impl_->run(*new_job);
        lock.lock();
    }
    Impl::Job* job = record.job;
    if (job) {
        impl_->job_done.wait(lock, [job] { return job->is_done; });
    }
    record.diag.deliver(impl_->diag);
    if (job) {
        job->diag.deliver(impl_->diag);
    }
    return job ? job->object : nullptr;
}

void ShaderLibrary::prefetch(std::string_view name, base::SourcePos pos, Path path) {
    const std::string stem = shader_stem(name);
    const std::lock_guard lock(impl_->mutex);
    if (impl_->adopted.contains(stem)) {
        return;
    }
    Impl::Job* new_job = nullptr;
    impl_->look_up(stem, pos, path, new_job);
    if (new_job) {
        impl_->queue.add([impl = impl_.get(), new_job] { impl->run(*new_job); });
    }
}

const ShaderObject* ShaderLibrary::find_special(const SpecialShader& special) {
    return impl_->known_special(special.key);
}

const ShaderObject* ShaderLibrary::make_special(const SpecialShader& special,
                                                const Cancelled& cancelled) {
    const ShaderObject* known = impl_->known_special(special.key);
    return known ? known : impl_->make_special(special, cancelled);
}

const ShaderLibrary::Config& ShaderLibrary::config() const {
    return impl_->config;
}

void ShaderLibrary::stop() {
    impl_->stop();
}

LibraryStats ShaderLibrary::stats() const {
    const auto seconds = [](std::uint64_t ns) { return 1e-9 * static_cast<double>(ns); };
    const Impl::Counts& c = impl_->counts;
    LibraryStats s;
    s.objects = c.objects;
    s.cache_hits = c.cache_hits;
    s.cache_misses = c.cache_misses;
    s.compiled = c.compiled;
    s.compiled_special = c.compiled_special;
    s.search_seconds = seconds(c.search_ns);
    s.compile_seconds = seconds(c.compile_ns);
    s.special_seconds = seconds(c.special_ns);
    s.load_seconds = seconds(c.load_ns);
    return s;
}

const ShaderObject* ShaderLibrary::load(const std::string& slo_path, base::SourcePos pos) {
    std::string why;
    const ShaderObject* object = impl_->open(slo_path, why);
    if (!object) {
        impl_->diag.report(base::Severity::Error, base::Code::NoShader, pos, slo_path + " " + why);
    }
    return object;
}

const ShaderObject* ShaderLibrary::adopt(const sl_object& object) {
    {
        const std::lock_guard lock(impl_->mutex);
        const auto it = impl_->adopted.find(object.name ? object.name : "");
        if (it != impl_->adopted.end() && &it->second->object() == &object) {
            return it->second;
        }
    }
    std::string why;
    auto shader = ShaderObject::adopt(object, strings_, why);
    if (!shader) {
        impl_->diag.report(base::Severity::Error, base::Code::Bug, {},
                           "built-in shader object " + why);
        return nullptr;
    }
    const ShaderObject* kept = impl_->keep({}, std::move(shader));
    const std::lock_guard lock(impl_->mutex);
    impl_->adopted.insert_or_assign(object.name, kept);
    return kept;
}

} // namespace rt
