// Fills a store, in the order of a seed, and says what was acknowledged.
//
//   store_writer [OPTIONS] FOLDER
//
//   --seed S            what is drawn (1)
//   --first N           number of the first slot (1)
//   --count N           how many slots (1)
//   --marks DEVICE@BYTE after each acknowledgement a mark on this disk from this byte on
//   --careless all|names  the card's syncs do nothing; or those of folders alone
//   --reserve BYTES     left free on the card (1 MiB)
//   --housekeeping      in between snapshots are pulled, and pulled ones pruned
//
// Lines, which are also the marks:
//
//   opened finished A interrupted B rows C
//   begun SEQUENCE
//   done|missed SEQUENCE SUMS FOLDER BYTES    durable when the line is there
//   pulled SEQUENCE
//   going SEQUENCE      may be gone from now on
//
// and, without a mark: "turned SEQUENCE: why" for a snapshot that became a miss, "failed N why", where N is the fault's
// number and the exit code. The first failure ends the program.
#include "careless_medium.h"
#include "drawn_snapshot.h"
#include "marks.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/os/sha256.h"
#include "dicot/record/record.h"
#include "dicot/store/store.h"

#include <array>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace dicot;

struct Words
{
    std::uint64_t seed = 1;
    int first = 1, count = 1;
    std::string marks, folder, careless;
    bool housekeeping = false;
    StoreRules rules{.reserve_bytes = std::uint64_t{1} << 20, .prune = Prune::kPulled};
};

class Writer
{
public:
    Writer(const Words& words, Medium& card, Store& store, std::optional<Marks> marks)
        : words_(words), card_(card), store_(store), marks_(std::move(marks))
    {
    }

    Status run()
    {
        const StartReport& start = store_.start_report();
        TRY(say("opened finished %d interrupted %d rows %d", start.finished, start.interrupted, start.rows_added));
        for (int number = words_.first; number < words_.first + words_.count; ++number) {
            TRY(take(number));
            if (words_.housekeeping && number % 4 == 0)
                TRY(pull());
            if (words_.housekeeping && number % 9 == 0)
                TRY(prune());
        }
        return {};
    }

private:
    struct Kept
    {
        std::int64_t sequence, began_us;
        ShortText<64> sums;
    };

    /// A line, on the screen and on the disk.
    template <typename... Values>
    Status say(const char* format, Values... values)
    {
        char line[400];
        std::snprintf(line, sizeof line, format, values...);
        if (marks_)
            TRY(marks_->put("%s", line));
        std::puts(line);
        std::fflush(stdout);
        return {};
    }

    Status take(int number)
    {
        const DrawnSnapshot drawn = draw_snapshot(words_.seed, number);
        TRY(store_.begin({.began_us = drawn.began_us, .due_us = std::nullopt}));
        const std::int64_t sequence = store_.sequence();
        const std::string folder = store_.folder();
        TRY(say("begun %" PRId64, sequence));
        SlotOutcome outcome{.done = !drawn.missed, .reason = {}, .clock_trust = "set", .points = 0};
        if (drawn.missed)
            outcome.reason = "drawn as a miss";
        if (const Status why = settle(drawn, outcome); !why.ok()) {
            std::printf("turned %" PRId64 ": %s\n", sequence, why.message());
            TRY(store_.take_back());
            outcome.done = false;
            outcome.reason = why.message();
            TRY(settle(drawn, outcome));
        }
        const ShortText<64> sums = TRY(sums_of(folder));
        TRY(say("%s %" PRId64 " %s %s %" PRIu64, outcome.done ? "done" : "missed", sequence, sums.c_str(),
                folder.c_str(), bytes_));
        kept_.push_back({sequence, drawn.began_us, sums});
        return {};
    }

    Status settle(const DrawnSnapshot& drawn, const SlotOutcome& outcome)
    {
        if (outcome.done)
            TRY(fill(drawn));
        TRY(add_record(drawn, outcome));
        bytes_ = 0;
        store_.for_each_added([this](const Store::Added& added) { bytes_ += added.bytes; });
        return store_.commit(outcome);
    }

    Status fill(const DrawnSnapshot& drawn)
    {
        TRY(store_.make_room());
        for (int index = 0; index < drawn.file_count; ++index)
            TRY(store_.add(drawn.files[index].name, [&](ByteSink& sink) { return write_drawn(drawn, index, sink); }));
        return {};
    }

    Status add_record(const DrawnSnapshot& drawn, const SlotOutcome& outcome)
    {
        const RecordFacts facts{.sequence = store_.sequence(),
                                .began_us = drawn.began_us,
                                .due_us = std::nullopt,
                                .done = outcome.done,
                                .reason = outcome.reason,
                                .clock_trust = outcome.clock_trust,
                                .points = outcome.points};
        std::array<char, 4096> text;
        const std::size_t bytes = write_plain_record(facts, "store_writer", text);
        return store_.add("record.json",
                          [&](ByteSink& sink) { return sink.write(std::as_bytes(std::span{text}.first(bytes))); });
    }

    /// Of SHA256SUMS as it stands there now.
    Result<ShortText<64>> sums_of(const std::string& folder)
    {
        const std::string path = folder + "/SHA256SUMS";
        Medium::File file;
        std::uint64_t size = 0;
        if (const Errno error = card_.open(path.c_str(), file, size); !error.ok())
            return failure(Fault::kIoError, "%s: %s", path.c_str(), std::strerror(error.number()));
        std::vector<std::byte> text(static_cast<std::size_t>(size));
        std::size_t got = 0;
        const Errno read = card_.read(file, text, got);
        const Errno closed = card_.close(file);
        if (!read.ok() || !closed.ok() || got != text.size())
            return failure(Fault::kIoError, "%s cannot be read", path.c_str());
        return ShortText<64>{hex_of(sha256_of(text)).data()};
    }

    /// The newest, and all but the newest two, so that there is something to prune.
    Status pull()
    {
        std::vector<Pull> pulls;
        for (std::size_t at = pulled_; at < kept_.size(); ++at)
            if (at + 2 < kept_.size() || at + 1 == kept_.size())
                pulls.push_back({kept_[at].sequence, kept_[at].sums, kept_.back().began_us + 1'000'000});
        pulled_ = kept_.size();
        TRY(store_.mark_pulled(pulls));
        for (const Pull& pull : pulls)
            TRY(say("pulled %" PRId64, pull.sequence));
        return {};
    }

    Status prune()
    {
        const Kept& middle = kept_[kept_.size() / 2];
        PruneWish wish{.free_bytes = 0, .older_than_us = middle.began_us, .dry_run = true};
        std::vector<std::int64_t> going;
        TRY(store_.prune(wish, [&](const SlotRow& row) { going.push_back(row.sequence); }));
        for (const std::int64_t sequence : going)
            TRY(say("going %" PRId64, sequence));
        wish.dry_run = false;
        const PruneReport report = TRY(store_.prune(wish, [](const SlotRow&) {}));
        if (report.removed != static_cast<int>(going.size()))
            return failure(Fault::kSoftware, "%zu were going and %d went", going.size(), report.removed);
        return {};
    }

    const Words& words_;
    Medium& card_;
    Store& store_;
    std::optional<Marks> marks_;
    std::vector<Kept> kept_;
    std::size_t pulled_ = 0;
    std::uint64_t bytes_ = 0;
};

Status run(const Words& words)
{
    const std::unique_ptr<Medium> disk = TRY(open_disk_medium(words.folder));
    CarelessMedium careless{*disk, words.careless == "names"};
    Medium& card = words.careless.empty() ? *disk : static_cast<Medium&>(careless);
    std::optional<Marks> marks;
    if (const std::size_t at = words.marks.find('@'); at != std::string::npos)
        marks.emplace(TRY(Marks::open(words.marks.substr(0, at).c_str(), std::atoll(words.marks.c_str() + at + 1))));
    const std::unique_ptr<Store> store =
        TRY(Store::open(card, words.rules, words.folder + "/" + Store::kCatalogueName));
    return Writer{words, card, *store, std::move(marks)}.run();
}

bool read_words(int count, char** word, Words& words)
{
    for (int at = 1; at < count; ++at) {
        const std::string name = word[at];
        const char* value = at + 1 < count ? word[at + 1] : "";
        if (name == "--housekeeping")
            words.housekeeping = true;
        else if (name.rfind("--", 0) != 0)
            words.folder = name;
        else {
            ++at;
            if (name == "--seed")
                words.seed = std::strtoull(value, nullptr, 10);
            else if (name == "--first")
                words.first = std::atoi(value);
            else if (name == "--count")
                words.count = std::atoi(value);
            else if (name == "--careless")
                words.careless = value;
            else if (name == "--marks")
                words.marks = value;
            else if (name == "--reserve")
                words.rules.reserve_bytes = std::strtoull(value, nullptr, 10);
            else
                return false;
        }
    }
    return !words.folder.empty();
}

} // namespace

int main(int count, char** word)
{
    Words words;
    if (!read_words(count, word, words)) {
        std::puts("failed 64 see the first lines of store_writer.cpp");
        return 64;
    }
    const Status outcome = run(words);
    if (!outcome.ok())
        std::printf("failed %d %s\n", outcome.exit_code(), outcome.message());
    return outcome.exit_code();
}
