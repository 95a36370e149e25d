#include "told_by.h"

#include "../commands.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

namespace dicot::app {
namespace {

constexpr std::size_t kMostText = std::size_t{64} << 20;

/// Sends a stream into memory for as long as it lives.
class Caught
{
public:
    explicit Caught(std::FILE* stream)
        : stream_(stream), target_(::fileno(stream)), memory_(::memfd_create("dicot", MFD_CLOEXEC))
    {
        (void)std::fflush(stream_);
        kept_ = ::dup(target_);
        if (memory_ >= 0 && kept_ >= 0)
            (void)::dup2(memory_, target_);
    }
    Caught(const Caught&) = delete;
    Caught& operator=(const Caught&) = delete;
    ~Caught()
    {
        release();
        if (memory_ >= 0)
            (void)::close(memory_);
    }
    bool works() const { return memory_ >= 0 && kept_ >= 0; }
    std::string text()
    {
        release();
        std::string all;
        char part[4096];
        ::ssize_t got = 0;
        while (all.size() < kMostText &&
               (got = ::pread(memory_, part, sizeof part, static_cast<::off_t>(all.size()))) > 0)
            all.append(part, static_cast<std::size_t>(got));
        return all;
    }

private:
    void release()
    {
        if (kept_ < 0)
            return;
        (void)std::fflush(stream_);
        (void)::dup2(kept_, target_);
        (void)::close(kept_);
        kept_ = -1;
    }

    std::FILE* stream_;
    int target_, memory_, kept_ = -1;
};

} // namespace

Told told_by(std::vector<std::string> words)
{
    CLI::App program;
    program.require_subcommand(1);
    Command chosen;
    add_config(program, chosen);
    add_health(program, chosen);
    add_list(program, chosen);
    add_memory(program, chosen);
    add_probe(program, chosen);
    add_schedule(program, chosen);
    Told told;
    std::reverse(words.begin(), words.end()); // as CLI11 wants them
    try {
        program.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
        told.status = failure(Fault::kUsage, "%s", error.what());
        return told;
    }
    Caught out(stdout), remarks(stderr);
    if (!out.works() || !remarks.works()) {
        told.status = failure(Fault::kOsError, "what a command tells cannot be kept: the system refused memory");
        return told;
    }
    told.status = chosen();
    told.text = out.text();
    told.remarks = remarks.text();
    return told;
}

} // namespace dicot::app
