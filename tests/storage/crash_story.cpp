#include "crash_story.h"

#include "dicot/os/sha256.h"
#include "dicot/record/record.h"

#include <algorithm>
#include <span>

namespace dicot::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000;
constexpr std::int64_t kLateEvening = 1'780'358'280 * kSecond; ///< 2026-06-01T23:58:00Z
constexpr std::int64_t kNextDay = kLateEvening + 300 * kSecond;

std::string bytes_of_seed(unsigned seed, std::size_t count)
{
    Dice dice{seed};
    std::string bytes(count, '\0');
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<char>(dice.next()); });
    return bytes;
}

/// Every other minute was planned, half a minute before.
std::optional<std::int64_t> planned(std::int64_t began_us)
{
    return began_us / (60 * kSecond) % 2 == 0 ? std::optional{began_us - 30 * kSecond} : std::nullopt;
}

std::string record_of(std::int64_t sequence, std::int64_t began_us, const Content& content)
{
    RecordFacts facts;
    facts.sequence = sequence;
    facts.began_us = began_us;
    facts.due_us = planned(began_us);
    facts.done = content.done;
    facts.reason = content.reason.c_str();
    facts.clock_trust = "set";
    facts.points = content.done ? sequence * 10 : 0;
    char text[kMaxPlainRecordBytes];
    return {text, write_plain_record(facts, "a story", text)};
}

/// In two pieces, as writers do.
Status add(Store& store, const std::string& name, const std::string& bytes)
{
    return store.add(name.c_str(), [&](ByteSink& sink) -> Status {
        const auto all = std::as_bytes(std::span{bytes});
        TRY(sink.write(all.first(all.size() / 2)));
        return sink.write(all.subspan(all.size() / 2));
    });
}

Status add_all(Store& store, const Content& content)
{
    for (const auto& [name, bytes] : content.files)
        TRY(add(store, name, bytes));
    return {};
}

Status begin(CrashMedium& card, Store& store, std::int64_t began_us, Told& told)
{
    const std::int64_t before = store.sequence();
    const Moment from = card.log().size();
    told.due_us = planned(began_us);
    const Status begun = store.begin({began_us, told.due_us});
    if (store.sequence() == before)
        return begun.ok() ? failure(Fault::kSoftware, "a snapshot without a number of its own") : begun;
    told.begin_from = from;
    told.sequence = store.sequence();
    told.folder = store.folder();
    TRY(begun);
    told.begun = card.log().size();
    return {};
}

Status commit(CrashMedium& card, Store& store, Told& told, const Content& content)
{
    told.contents.push_back(content);
    told.commit_from = std::min(told.commit_from, card.log().size());
    TRY(store.commit({content.done, content.reason.c_str(), "set", content.done ? told.sequence * 10 : 0}));
    told.acknowledged = card.log().size();
    return {};
}

class Teller
{
public:
    Teller(CrashMedium& card, CrashVfs& vfs, const StoryRules& rules) : card_(card), rules_(rules) { vfs.use(card); }

    Story tell();
    Story tell_until_full(int slots);
    Story tell_with_a_thief();
    Story tell_of_small_card();

private:
    bool open();
    void snapshot(std::int64_t began_us);
    void miss(std::int64_t began_us);
    void pull(std::initializer_list<std::size_t> which);
    void prune(std::int64_t older_than_us);
    bool noted(const Status& status);

    CrashMedium& card_;
    StoryRules rules_;
    Story story_;
    std::unique_ptr<Store> store_;
    unsigned seed_ = 1;
};

bool Teller::noted(const Status& status)
{
    if (status.ok())
        return true;
    if (++story_.refusals == 1)
        story_.first_refusal = status.message();
    return false;
}

bool Teller::open()
{
    store_.reset();
    for (int attempt = 0; attempt < 2; ++attempt) {
        auto opened = Store::open(card_, rules_.store, Store::kCatalogueName, CrashVfs::kName);
        if (!noted(opened.status()))
            continue;
        store_ = std::move(opened).value();
        return true;
    }
    return false;
}

void Teller::snapshot(std::int64_t began_us)
{
    Told told;
    const Status stored = store_snapshot(card_, *store_, began_us, seed_++, rules_.most_file_bytes, told);
    if (!noted(stored) && told.begun != kNever) {
        const Status recorded = [&]() -> Status {
            TRY(store_->take_back());
            Content content{false, "the card said no", {}};
            content.files["record.json"] = record_of(told.sequence, began_us, content);
            TRY(add_all(*store_, content));
            TRY(commit(card_, *store_, told, content));
            ++story_.misses;
            return {};
        }();
        noted(recorded);
    }
    if (told.begin_from != kNever)
        story_.all.push_back(told);
}

/// First some of a snapshot, then what hindered it.
void Teller::miss(std::int64_t began_us)
{
    Told told;
    const Status missed = [&]() -> Status {
        TRY(begin(card_, *store_, began_us, told));
        TRY(add(*store_, "left.jpg", bytes_of_seed(seed_++, rules_.most_file_bytes / 2)));
        TRY(store_->take_back());
        Content content{false, "no camera", {}};
        content.files["record.json"] = record_of(told.sequence, began_us, content);
        TRY(add_all(*store_, content));
        return commit(card_, *store_, told, content);
    }();
    noted(missed);
    if (told.begin_from != kNever)
        story_.all.push_back(told);
}

void Teller::pull(std::initializer_list<std::size_t> which)
{
    std::vector<Pull> pulls;
    for (const std::size_t k : which) {
        if (k >= story_.all.size() || story_.all[k].acknowledged == kNever)
            continue;
        const Result<std::optional<SlotRow>> row = store_->catalogue().find(story_.all[k].sequence);
        if (noted(row.status()) && row.value())
            pulls.push_back({row.value()->sequence, row.value()->sums, kNextDay + 7 * kSecond});
    }
    const auto each = [&](auto&& change) {
        for (Told& told : story_.all)
            for (const Pull& pull : pulls)
                if (pull.sequence == told.sequence)
                    change(told, pull);
    };
    each([&](Told& told, const Pull& pull) { told.pulled_us = pull.pulled_us, told.pull_from = card_.log().size(); });
    if (noted(store_->mark_pulled(pulls)))
        each([&](Told& told, const Pull&) { told.pulled = card_.log().size(); });
}

void Teller::prune(std::int64_t older_than_us)
{
    PruneWish wish;
    wish.older_than_us = older_than_us;
    const auto pruned = store_->prune(wish, [&](const SlotRow& row) {
        for (Told& told : story_.all)
            if (told.sequence == row.sequence)
                told.prune_from = std::min(told.prune_from, card_.log().size());
    });
    noted(pruned.status());
}

Story Teller::tell()
{
    if (!open())
        return story_;
    snapshot(kLateEvening);
    snapshot(kNextDay); // the next day begins
    miss(kNextDay + 60 * kSecond);
    pull({0, 1});
    snapshot(5 * kSecond); // 1970
    prune(kNextDay);       // the first one, and with it its day
    snapshot(kNextDay + 600 * kSecond);
    if (!open())
        return story_;
    pull({3});
    prune(kNextDay); // 1970's
    snapshot(kNextDay + 900 * kSecond);
    store_.reset();
    return story_;
}

Story Teller::tell_until_full(int slots)
{
    if (!open())
        return story_;
    for (int k = 0; k < slots; ++k)
        snapshot(kNextDay + k * 60 * kSecond);
    store_.reset();
    return story_;
}

Story Teller::tell_of_small_card()
{
    constexpr int kFirst = 4;
    constexpr int kThen = 5;
    constexpr std::uint64_t kRoomBytes = 7 * 4096;
    if (!open())
        return story_;
    for (int k = 0; k < kFirst + kThen; ++k) {
        if (k == kFirst)
            card_.set_capacity(card_.now().used_bytes() + kRoomBytes);
        for (Told& told : story_.all)
            told.prune_from = k < kFirst ? kNever : std::min(told.prune_from, card_.log().size());
        snapshot(kLateEvening + k * 60 * kSecond);
    }
    store_.reset();
    return story_;
}

Story Teller::tell_with_a_thief()
{
    if (!open())
        return story_;
    snapshot(kNextDay);
    card_.set_capacity(card_.now().used_bytes() + 3 * 4096);
    rules_.store.reserve_bytes = 0;
    snapshot(kNextDay + 60 * kSecond);
    store_.reset();
    return story_;
}

} // namespace

Status store_snapshot(CrashMedium& card, Store& store, std::int64_t began_us, unsigned seed,
                      std::size_t most_file_bytes, Told& told)
{
    TRY(begin(card, store, began_us, told));
    TRY(store.make_room());
    Dice dice{seed};
    Content content{true, "", {}};
    content.files["cloud.drc"] = bytes_of_seed(seed * 2, 600 + dice.below(most_file_bytes));
    content.files["left.jpg"] = bytes_of_seed(seed * 2 + 1, 1 + dice.below(most_file_bytes));
    content.files["record.json"] = record_of(told.sequence, began_us, content);
    TRY(add_all(store, content));
    return commit(card, store, told, content);
}

Story tell(CrashMedium& card, CrashVfs& vfs, const StoryRules& rules)
{
    return Teller(card, vfs, rules).tell();
}

Story tell_until_full(CrashMedium& card, CrashVfs& vfs, const StoryRules& rules, int slots)
{
    return Teller(card, vfs, rules).tell_until_full(slots);
}

Story tell_of_small_card(CrashMedium& card, CrashVfs& vfs)
{
    StoryRules rules;
    rules.store = {0, Prune::kAll};
    return Teller(card, vfs, rules).tell_of_small_card();
}

Story tell_with_a_thief(CrashMedium& card, CrashVfs& vfs, const StoryRules& rules)
{
    return Teller(card, vfs, rules).tell_with_a_thief();
}

} // namespace dicot::test
