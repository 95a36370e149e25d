// dicot verify: whether every file is still what was written.
#include "commands.h"
#include "progress.h"
#include "store/shown.h"
#include "store/slot_words.h"
#include "store/store_words.h"

#include "dicot/medium/disk_medium.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct Words
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

/// A damaged snapshot is not made whole, but a repair moves it out of the way.
bool is_dealt_with(const Finding& finding, bool repair) noexcept
{
    return finding.mended || (repair && finding.sequence > 0 &&
                              (finding.kind == Finding::Kind::kDamaged || finding.kind == Finding::Kind::kMissing));
}

/// What is lost or wrong as long as nobody deals with it.
bool is_damage(const Finding& finding, bool repair) noexcept
{
    return !is_dealt_with(finding, repair) &&
           (finding.kind == Finding::Kind::kDamaged || finding.kind == Finding::Kind::kMissing ||
            finding.kind == Finding::Kind::kCatalogue);
}

struct Verified
{
    VerifyReport report;
    nlohmann::json findings = nlohmann::json::array();
    int damage = 0;
    int dealt_with = 0;
};

Result<Verified> verify(const DeviceFolder& device, const StoreRules& rules, bool repair)
{
    Verified verified;
    const auto found = [&](const Finding& finding) {
        verified.dealt_with += is_dealt_with(finding, repair) ? 1 : 0;
        verified.damage += is_damage(finding, repair) ? 1 : 0;
        verified.findings.push_back(
            {{"kind", name_of(finding.kind)},
             {"sequence", finding.sequence > 0 ? nlohmann::json(finding.sequence) : nlohmann::json()},
             {"path", finding.path},
             {"sentence", finding.sentence},
             {"dealt_with", is_dealt_with(finding, repair)}});
    };
    Progress bar("verifying");
    const auto progress = [&bar](int done, int all) { bar.done(done, all); };
    if (repair) {
        const WrittenStore store = TRY(WrittenStore::open(device.path, rules));
        verified.report = TRY(store.store->verify(true, found, progress));
    } else {
        const std::unique_ptr<Medium> medium = TRY(open_disk_medium(device.path));
        verified.report = TRY(verify_store(*medium, device.path + "/" + Store::kCatalogueName, found, progress));
    }
    return verified;
}

void print(const DeviceFolder& device, const Verified& verified)
{
    const std::string path = shown(device.path);
    for (const nlohmann::json& finding : verified.findings)
        std::printf("%s/%s: %s: %s%s\n", path.c_str(), shown(finding["path"].get<std::string>()).c_str(),
                    finding["kind"].get<std::string>().c_str(), shown(finding["sentence"].get<std::string>()).c_str(),
                    finding["dealt_with"].get<bool>() ? " (dealt with)" : "");
    const VerifyReport& report = verified.report;
    std::printf("%s: %s and %s read; ", path.c_str(), counted(report.folders, "folder").c_str(),
                shown_bytes(static_cast<double>(report.bytes)).c_str());
    if (report.findings == 0)
        std::printf("everything is as it was written");
    else
        std::printf("%s, %d dealt with", counted(report.findings, "finding").c_str(), verified.dealt_with);
    if (report.in_quarantine > 0)
        std::printf("; %s in quarantine", counted(report.in_quarantine, "folder").c_str());
    std::printf("\n");
}

Status run(const Words& words)
{
    const FoundStores found = TRY(words.store.find());
    const StoreRules rules = rules_of(found.output);
    nlohmann::json stores = nlohmann::json::array();
    int damage = 0;
    for (const DeviceFolder& device : found.devices) {
        const Verified verified = TRY(verify(device, rules, words.repair));
        damage += verified.damage;
        if (!words.json) {
            print(device, verified);
            continue;
        }
        stores.push_back({{"device", device.device},
                          {"path", device.path},
                          {"folders", verified.report.folders},
                          {"bytes", verified.report.bytes},
                          {"dealt_with", verified.dealt_with},
                          {"damaged", verified.damage},
                          {"in_quarantine", verified.report.in_quarantine},
                          {"findings", verified.findings}});
    }
    if (words.json)
        std::printf("%s\n", json_text({{"root", found.root}, {"stores", stores}}).c_str());
    else if (found.devices.empty())
        std::printf("%s: there is no snapshot yet, so none is damaged\n", shown(found.root).c_str());
    if (damage == 0)
        return {};
    return failure(Fault::kBadData, "%s: %s not as written: %s", shown(found.root).c_str(),
                   damage == 1 ? "1 thing is" : (std::to_string(damage) + " things are").c_str(),
                   words.repair
                       ? "what could not be dealt with is named above"
                       : "dicot verify --repair moves damaged folders to quarantine and makes the catalogue again");
}

} // namespace

void add_verify(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("verify", "Reads and hashes all that is stored; exit code 65 if something is damaged");
    auto words = std::make_shared<Words>();
    command->add_flag("--repair", words->repair,
                      "damaged folders to quarantine, the catalogue made again of the folders; nothing is deleted");
    words->store.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
