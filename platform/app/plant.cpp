// dicot plant: the plants and leaves of one cloud, measured.
#include "cloud_on_disk.h"
#include "commands.h"
#include "distinct_files.h"
#include "plant/leaf_cloud.h"
#include "plant/plant_places.h"
#include "plant/plant_report.h"
#include "store/found_slot.h"
#include "store/shown.h"
#include "store/slot_words.h"
#include "store/store_outcome.h"
#include "store/store_words.h"

#include "dicot/os/output_file.h"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct PlantWords
{
    StoreWords store;
    std::string cloud; ///< a file, or the number of a slot
    std::string places, output, csv, leaf_csv;
    bool json = false;
};

/// The cloud's file. A number is a slot; a file that is called so needs its folder.
Result<std::string> cloud_of(const PlantWords& words)
{
    std::int64_t sequence = 0;
    const char* const end = words.cloud.data() + words.cloud.size();
    const auto [stopped, fault] = std::from_chars(words.cloud.data(), end, sequence);
    if (words.cloud.empty() || stopped != end || words.cloud.front() == '-')
        return words.cloud;
    if (fault != std::errc{} || sequence == 0)
        return failure(Fault::kUsage, "%s: there is no slot of this number", shown(words.cloud).c_str());
    const FoundStores found = TRY(words.store.find());
    StoreOutcome outcome(found);
    const FoundSlot slot = TRY(find_slot(found, sequence, outcome));
    if (slot.row.kept != Kept::kHere || !slot.row.done)
        return failure(Fault::kNoInput, "%s of %s: %s: it has no cloud", words.cloud.c_str(),
                       shown(slot.device.device).c_str(), state_of(slot.row));
    return slot.device.path + "/" + folder_of(slot.row.sequence, slot.row.began_us).c_str() + "/cloud.drc";
}

/// "traits.leaves.csv" of "traits.csv".
std::string beside(const std::string& csv)
{
    if (csv.empty())
        return {};
    return (csv.ends_with(".csv") ? csv.substr(0, csv.size() - 4) : csv) + ".leaves.csv";
}

Status write_text(const std::string& path, const std::string& text)
{
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(text.data(), text.size()));
    return file.commit();
}

Status run(const PlantWords& words)
{
    if (!words.output.empty() && !words.output.ends_with(".drc") && !words.output.ends_with(".ply"))
        return failure(Fault::kUsage, "%s: the name must end in .drc or .ply", shown(words.output).c_str());
    const std::string path = TRY(cloud_of(words));
    const std::string leaf_csv = words.leaf_csv.empty() ? beside(words.csv) : words.leaf_csv;
    TRY(check_distinct({path, words.places}, {words.output, words.csv, leaf_csv}));
    std::vector<PlantPlace> places;
    if (!words.places.empty())
        places = TRY(read_plant_places(words.places));
    const CloudOnDisk cloud = TRY(CloudOnDisk::read(path.c_str()));
    const PlantWork work = TRY(PlantWork::make(cloud.cloud(), path.c_str(), places, cloud.meta().far_mm.value_or(0)));
    const PlantReport report{work, path, cloud.meta()};
    if (!words.output.empty())
        TRY(write_leaf_cloud(words.output, work, cloud.meta()));
    if (!words.csv.empty())
        TRY(write_text(words.csv, plant_table(report)));
    if (!leaf_csv.empty())
        TRY(write_text(leaf_csv, leaf_table(report)));
    if (words.json)
        std::printf("%s\n", json_text(plant_json(report)).c_str());
    else
        std::printf("%s", plant_words(report).c_str());
    return {};
}

} // namespace

void add_plant(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("plant", "The plants of a cloud: leaves, lengths, areas, heights");
    auto words = std::make_shared<PlantWords>();
    command->add_option("CLOUD", words->cloud, "cloud file (.drc), or the number of a slot, as dicot list has it")
        ->required();
    command
        ->add_option("--plants", words->places,
                     "plants by name: CSV with name, min_x_mm .. max_z_mm, boxes in the ground frame")
        ->type_name("FILE");
    command
        ->add_option(
            "-o,--output", words->output,
            "the cloud in the leaves' colours, with the number of its leaf for each point: .drc; with the plant's "
            "too: .ply")
        ->type_name("FILE");
    command->add_option("--csv", words->csv, "a line a plant; and a line a leaf in NAME.leaves.csv")->type_name("FILE");
    command->add_option("--leaf-csv", words->leaf_csv, "a line a leaf, here")->type_name("FILE");
    command->add_flag("--json", words->json, "report as JSON, laid out as PlantCV's results");
    words->store.add_to(*command);
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
