#include "plant_pairs.h"

#include "calibration_data.h"
#include "matched.h"
#include "own_rig.h"
#include "plant_pictures.h"
#include "sgbm.h"

#include <cstdio>
#include <future>
#include <mutex>
#include <optional>

namespace dicot::test {
namespace {

std::string folder_of(std::size_t plant)
{
    return data_path(std::string("rig-dev/plants/") + kPlants[plant]);
}

PlantPair look_at(std::size_t plant, std::size_t light)
{
    static const RectifiedView own(own_rig());
    static const RectifiedView rendered(rig_dev_truth());
    const std::string stem = folder_of(plant) + "/" + kLights[light];
    PlantPair pair{std::string(kPlants[plant]) + " " + kLights[light], scenes::read(stem + "_left.jpg"), {}, {}};
    const scenes::Picture right = scenes::read(stem + "_right.jpg");

    auto peer = std::async(std::launch::async, [&] {
        return rendered.on_raw_pixels(sgbm_hh(rendered.left(pair.left), rendered.right(right), rendered.range()));
    });
    const scenes::Picture flat_left = own.left(pair.left), flat_right = own.right(right);
    const Matched matched(flat_left.view(), flat_right.view(), own.options(MatchMethod::kBest));
    pair.ours = own.on_raw_pixels(disparities_of(matched.map()));
    pair.peer = peer.get();

    static std::once_flag begun;
    std::call_once(begun, [] {
        std::printf("pictures: %s\n", DICOT_PICTURES_DIR);
        print_head();
    });
    print_row(pair.name.c_str(), "ours", leaf_figures(plant, pair.ours));
    print_row("", "SGBM", leaf_figures(plant, pair.peer));
    const std::string drawn = std::string(kPlants[plant]) + "_" + kLights[light];
    draw_match(drawn, matched.map(), flat_left, own, plant_truth(plant));
    draw_errors(drawn, pair, plant_truth(plant));
    return pair;
}

} // namespace

const TrueDepth& plant_truth(std::size_t plant)
{
    static std::array<std::optional<TrueDepth>, kPlants.size()> truths;
    if (!truths[plant])
        truths[plant] = read_truth(folder_of(plant));
    return *truths[plant];
}

const PlantPair& plant_pair(std::size_t plant, std::size_t light)
{
    static std::array<std::array<std::optional<PlantPair>, kLights.size()>, kPlants.size()> pairs;
    if (!pairs[plant][light])
        pairs[plant][light] = look_at(plant, light);
    return *pairs[plant][light];
}

std::vector<const PlantPair*> all_plant_pairs()
{
    std::vector<const PlantPair*> all;
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant)
        for (std::size_t light = 0; light < kLights.size(); ++light)
            all.push_back(&plant_pair(plant, light));
    return all;
}

DepthFigures leaf_figures(std::size_t plant, const RawDepth& depth)
{
    const TrueDepth& truth = plant_truth(plant);
    return figures_of(depth, truth, truth.leaf);
}

} // namespace dicot::test
