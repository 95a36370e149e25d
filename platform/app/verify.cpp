// dicot verify: whether every file is still what was written.
#include "commands.h"
#include "progress.h"
#include "store/shown.h"
#include "store/slot_record.h"
#include "store/slot_words.h"
#include "store/start_words.h"
#include "store/store_outcome.h"
#include "store/store_words.h"

#include "dicot/medium/disk_medium.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct VerifyWords
{
    StoreWords store;
    bool repair = false;
    bool json = false;
};

const char* name_of(Finding::Kind kind) noexcept
{
    switch (kind) {
    case Finding::Kind::kDamaged:
        return "damaged";
    case Finding::Kind::kMissing:
        return "missing";
    case Finding::Kind::kStranger:
        return "stranger";
    case Finding::Kind::kCatalogue:
        return "catalogue";
    case Finding::Kind::kLeftOver:
        break;
    }
    return "left over";
}

/// What is lost or wrong as long as nobody deals with it.
bool is_damage(const Finding& finding) noexcept
{
    return !finding.mended && (finding.kind == Finding::Kind::kDamaged || finding.kind == Finding::Kind::kMissing ||
                               finding.kind == Finding::Kind::kCatalogue);
}

struct Verified
{
    VerifyReport report;
    std::optional<StartReport> start; ///< of a repair
    nlohmann::json findings = nlohmann::json::array();
    int damage = 0;
    int dealt_with = 0;
};

void print(const DeviceFolder& device, const Finding& finding)
{
    std::printf("%s/%s: %s: %s%s\n", shown(device.path).c_str(), shown(finding.path).c_str(), name_of(finding.kind),
                shown(finding.sentence).c_str(), finding.mended ? " (dealt with)" : "");
    std::fflush(stdout);
}

/// What was found until a failure stays in `verified`.
Status verify(const VerifyWords& words, const DeviceFolder& device, const StoreRules& rules, Verified& verified)
{
    Progress bar("verifying");
    const auto found = [&](const Finding& finding) {
        verified.dealt_with += finding.mended ? 1 : 0;
        verified.damage += is_damage(finding) ? 1 : 0;
        if (!words.json) { // printed at once: the card may fail before the end
            bar.wipe();
            print(device, finding);
            return;
        }
        verified.findings.push_back(
            {{"kind", name_of(finding.kind)},
             {"sequence", finding.sequence > 0 ? nlohmann::json(finding.sequence) : nlohmann::json()},
             {"path", finding.path},
             {"sentence", finding.sentence},
             {"dealt_with", finding.mended}});
    };
    const auto progress = [&bar](int done, int all) { bar.done(done, all); };
    if (words.repair) {
        const WrittenStore store = TRY(WrittenStore::open(device.path, rules));
        verified.start = store.store->start_report();
        tell_start(*store.store, device.path);
        verified.report = TRY(store.store->verify(true, found, progress));
    } else {
        const std::unique_ptr<Medium> medium = TRY(open_disk_medium(device.path));
        verified.report = TRY(verify_store(*medium, device.path + "/" + Store::kCatalogueName, found, progress));
    }
    return {};
}

void print_sum(const DeviceFolder& device, const Verified& verified)
{
    const VerifyReport& report = verified.report;
    std::printf("%s: %s and %s read; ", shown(device.path).c_str(), counted(report.folders, "folder").c_str(),
                shown_bytes(static_cast<double>(report.bytes)).c_str());
    if (report.findings == 0)
        std::printf("everything is as it was written");
    else
        std::printf("%s, %d dealt with", counted(report.findings, "finding").c_str(), verified.dealt_with);
    if (report.in_quarantine > 0)
        std::printf("; %s in quarantine", counted(report.in_quarantine, "folder").c_str());
    std::printf("\n");
}

nlohmann::json json_of(const DeviceFolder& device, const Verified& verified, const Status& outcome)
{
    nlohmann::json told = {{"device", device.device},
                           {"path", device.path},
                           {"folders", verified.report.folders},
                           {"bytes", verified.report.bytes},
                           {"dealt_with", verified.dealt_with},
                           {"damaged", verified.damage},
                           {"in_quarantine", verified.report.in_quarantine},
                           {"findings", verified.findings}};
    if (verified.start)
        told["start"] = start_record(*verified.start);
    if (!outcome.ok())
        told["error"] = outcome.message();
    return told;
}

Status run(const VerifyWords& words)
{
    const FoundStores found = TRY(words.store.find());
    const StoreRules rules = rules_of(found.output);
    StoreOutcome outcome(found);
    nlohmann::json stores = nlohmann::json::array();
    int damage = 0;
    for (const DeviceFolder& device : found.devices) {
        Verified verified;
        const Status done = in_store(device.path, verify(words, device, rules, verified));
        damage += verified.damage;
        if (words.json)
            stores.push_back(json_of(device, verified, done));
        else if (done.ok())
            print_sum(device, verified);
        outcome.add(done);
    }
    if (words.json)
        std::printf("%s\n", json_text({{"root", found.root}, {"stores", stores}}).c_str());
    else if (found.devices.empty() && found.unread.empty())
        std::printf("%s: there is no snapshot yet, so none is damaged\n", shown(found.root).c_str());
    if (damage > 0)
        outcome.add(failure(
            Fault::kBadData, "%s: %s not as written: %s", shown(found.root).c_str(),
            damage == 1 ? "1 thing is" : (std::to_string(damage) + " things are").c_str(),
            words.repair ? "what could not be dealt with is named above"
                         : "dicot verify --repair moves damaged folders to quarantine and makes the catalogue again"));
    return outcome.worst();
}

} // namespace

void add_verify(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("verify", "Reads and hashes all that is stored; exit code 65 if something is damaged");
    auto words = std::make_shared<VerifyWords>();
    command->add_flag("--repair", words->repair,
                      "damaged folders to quarantine, the catalogue made again of the folders; nothing is deleted");
    words->store.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
