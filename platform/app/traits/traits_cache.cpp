#include "traits_cache.h"

#include "../store/shown.h"

#include "dicot/os/input_file.h"
#include "dicot/os/sha256.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace dicot::app {
namespace {

namespace fs = std::filesystem;

} // namespace

std::string usual_cache_folder()
{
    if (const char* const given = std::getenv("XDG_CACHE_HOME"); given != nullptr && given[0] == '/')
        return std::string{given} + "/dicot";
    const char* const home = std::getenv("HOME");
    return home != nullptr && home[0] == '/' ? std::string{home} + "/.cache/dicot" : std::string{};
}

Result<std::string> cache_maker()
{
    return "dicot traits 1 " + TRY(digest_of_file("/proc/self/exe"));
}

Result<std::string> digest_of_file(const std::string& path)
{
    InputFile file;
    TRY(file.open(path.c_str()));
    Sha256Stream stream;
    std::vector<std::byte> piece(std::size_t{1} << 18);
    for (;;) {
        const std::size_t got = TRY(file.read(piece));
        stream.update(std::span{piece}.first(got));
        if (got < piece.size())
            return std::string{hex_of(stream.finish()).data()};
    }
}

Result<TraitsCache> TraitsCache::open(const std::string& folder, const std::string& name, const std::string& maker)
{
    TraitsCache cache;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        return failure(Fault::kCannotCreate,
                       "%s: the folder of the cache cannot be made (%s): name another with --cache",
                       shown(folder).c_str(), error.message().c_str());
    cache.path_ = folder + "/" + name + ".traits";
    bool is_ours = false;
    {
        std::ifstream before(cache.path_, std::ios::binary);
        std::string line;
        is_ours = std::getline(before, line) && line == maker;
        while (is_ours && std::getline(before, line)) {
            const nlohmann::json one = nlohmann::json::parse(line, nullptr, false);
            if (!one.is_object() || !one.contains("sums") || !one["sums"].is_string() || !one.contains("traits"))
                continue;
            if (auto traits = traits_of(one["traits"]))
                cache.known_.insert_or_assign(one["sums"].get<std::string>(), std::move(*traits));
        }
    }
    if (!is_ours) // another program may still write to the old one
        fs::remove(cache.path_, error);
    cache.file_.reset(std::fopen(cache.path_.c_str(), "ae"));
    if (!cache.file_)
        return failure(Fault::kCannotCreate, "%s: %s: name another folder for the cache with --cache",
                       shown(cache.path_).c_str(), std::strerror(errno));
    // Behind a line that was cut off, the next one begins a line of its own.
    std::fprintf(cache.file_.get(), "%s\n", is_ours ? "" : maker.c_str());
    return cache;
}

const SnapshotTraits* TraitsCache::find(std::string_view sums) const
{
    const auto at = known_.find(sums);
    return at == known_.end() ? nullptr : &at->second;
}

Status TraitsCache::add(std::string_view sums, const SnapshotTraits& traits)
{
    if (!file_)
        return {};
    const std::string line = nlohmann::json{{"sums", sums}, {"traits", json_of(traits)}}.dump() + "\n";
    if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() || std::fflush(file_.get()) != 0)
        return failure(Fault::kIoError, "%s: %s", shown(path_).c_str(), std::strerror(errno));
    return {};
}

} // namespace dicot::app
