// What is in a store that power left, after the start-up's repair: lines for scripts.
//
//   store_state FOLDER            opens the store for writing, which repairs it
//   store_state --read FOLDER     only looks: neither "opened" nor "next"
//
//   opened finished A interrupted B rows C new D
//   row SEQUENCE done|missed here|pruned|quarantined|lost pulled|kept SUMS FOLDER
//   finding SEQUENCE mended|left PATH: SENTENCE    of a verify() without repair
//   verified FOLDERS findings N
//   next SEQUENCE           what the next snapshot got, which was then committed as a miss
//
// "failed N why" ends it; N is the fault's number and the exit code.
#include "dicot/medium/disk_medium.h"
#include "dicot/record/record.h"
#include "dicot/store/store.h"

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <string>

namespace {

using namespace dicot;

constexpr std::int64_t kNow_us = 1'790'000'000'000'000;
constexpr const char* kKept[] = {"here", "pruned", "quarantined", "lost"};

void print(const SlotRow& row)
{
    std::printf("row %" PRId64 " %s %s %s %s %s\n", row.sequence, row.done ? "done" : "missed",
                kKept[static_cast<int>(row.kept)], row.pulled_us ? "pulled" : "kept", row.sums.c_str(),
                folder_of(row.sequence, row.began_us).c_str());
}

Status take_one_more(Store& store)
{
    TRY(store.begin({.began_us = kNow_us, .due_us = std::nullopt}));
    const SlotOutcome outcome{.done = false, .reason = "taken by store_state", .clock_trust = "set", .points = 0};
    const RecordFacts facts{.sequence = store.sequence(),
                            .began_us = kNow_us,
                            .due_us = std::nullopt,
                            .done = false,
                            .reason = outcome.reason,
                            .clock_trust = outcome.clock_trust,
                            .points = 0};
    std::array<char, 4096> text;
    const std::size_t bytes = write_plain_record(facts, "store_state", text);
    TRY(store.add("record.json",
                  [&](ByteSink& sink) { return sink.write(std::as_bytes(std::span{text}.first(bytes))); }));
    std::printf("next %" PRId64 "\n", store.sequence());
    return store.commit(outcome);
}

Status print_rows(Catalogue& catalogue)
{
    return catalogue.for_each({}, [](const SlotRow& row) {
        print(row);
        return true;
    });
}

constexpr auto print_finding = [](const Finding& found) {
    std::printf("finding %" PRId64 " %s %s: %s\n", found.sequence, found.mended ? "mended" : "left", found.path,
                found.sentence);
};

void print_report(const VerifyReport& report)
{
    std::printf("verified %d findings %d\n", report.folders, report.findings);
}

Status repair(Medium& card, const std::string& catalogue)
{
    const std::unique_ptr<Store> store =
        TRY(Store::open(card, {.reserve_bytes = 0, .prune = Prune::kNever}, catalogue));
    const StartReport& start = store->start_report();
    std::printf("opened finished %d interrupted %d rows %d new %d\n", start.finished, start.interrupted,
                start.rows_added, start.catalogue_new ? 1 : 0);
    TRY(print_rows(store->catalogue()));
    print_report(TRY(store->verify(false, print_finding, [](int, int) {})));
    return take_one_more(*store);
}

Status look(Medium& card, const std::string& catalogue)
{
    {
        const std::unique_ptr<Catalogue> rows = TRY(read_catalogue(card, catalogue));
        TRY(print_rows(*rows));
    }
    print_report(TRY(verify_store(card, catalogue, print_finding, [](int, int) {})));
    return {};
}

Status run(const std::string& folder, bool only_look)
{
    const std::unique_ptr<Medium> card = TRY(open_disk_medium(folder));
    const std::string catalogue = folder + "/" + Store::kCatalogueName;
    return only_look ? look(*card, catalogue) : repair(*card, catalogue);
}

} // namespace

int main(int count, char** word)
{
    const bool only_look = count == 3 && std::strcmp(word[1], "--read") == 0;
    const Status outcome = count == 2 || only_look ? run(word[count - 1], only_look)
                                                   : failure(Fault::kUsage, "store_state [--read] FOLDER");
    if (!outcome.ok())
        std::printf("failed %d %s\n", outcome.exit_code(), outcome.message());
    return outcome.exit_code();
}
