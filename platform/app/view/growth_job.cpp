#include "growth_job.h"

#include "../cloud_on_disk.h"
#include "../plant/plant_work.h"
#include "../stop_request.h"

#include "dicot/os/memory_block.h"
#include "dicot/plant/growth.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace dicot::app {
namespace {

using nlohmann::json;

struct PlantTrait
{
    const char* key;
    const char* name;
    const char* unit;
    double scale; ///< from the key's unit to `unit`
    Measured PlantTraits::*value;
};

constexpr PlantTrait kTraits[] = {
    {"leaf_area_visible_mm2", "leaf area, visible", "cm²", 0.01, &PlantTraits::leaf_area_visible_mm2},
    {"height_p99_mm", "height, 99th percentile", "mm", 1, &PlantTraits::height_p99_mm},
    {"height_top10_mean_mm", "height, mean of the top tenth", "mm", 1, &PlantTraits::height_top10_mean_mm},
    {"projected_area_mm2", "area seen from above", "cm²", 0.01, &PlantTraits::projected_area_mm2},
    {"hull_volume_mm3", "volume of the hull", "cm³", 0.001, &PlantTraits::hull_volume_mm3},
    {"leaf_count", "leaves", "", 1, &PlantTraits::leaf_count},
    {"inclination_mean_deg", "inclination, mean", "°", 1, &PlantTraits::inclination_mean_deg},
};

/// Every 2^k-th, then those half-way between them, and so on.
std::vector<const SlotRow*> widely_first(const std::vector<SlotRow>& slots)
{
    std::vector<const SlotRow*> done, order;
    for (const SlotRow& row : slots)
        if (row.done && row.kept == Kept::kHere)
            done.push_back(&row);
    std::size_t step = 1;
    while (2 * step < done.size())
        step *= 2;
    for (bool first = true; step > 0; step /= 2, first = false)
        for (std::size_t i = 0; i < done.size(); i += step)
            if (first || i % (2 * step) != 0)
                order.push_back(done[i]);
    return order;
}

struct Series
{
    std::vector<const SlotRow*> rows;
    std::vector<GrowthSample> samples;
};

double day_of(const SlotRow& row)
{
    return static_cast<double>(row.began_us) / 86'400e6;
}

json curve_of(const GrowthFit& fit)
{
    json time = json::array(), value = json::array(), sd = json::array();
    for (const GrowthPoint& point : fit.curve) {
        time.push_back(point.day * 86'400);
        value.push_back(point.value.value); // what is not a number becomes null
        sd.push_back(point.value.sd);
    }
    return {{"time_s", time}, {"value", value}, {"sd", sd}};
}

/// Samples and, where there are enough of them for one, the curve.
json series_json(const Series& series)
{
    json sequence = json::array(), time = json::array(), value = json::array(), sd = json::array();
    std::string outlier(series.rows.size(), '0');
    for (std::size_t i = 0; i < series.rows.size(); ++i) {
        sequence.push_back(series.rows[i]->sequence);
        time.push_back(series.rows[i]->began_us / 1'000'000);
        value.push_back(series.samples[i].measured.value);
        sd.push_back(series.samples[i].measured.sd);
    }
    json told = {{"sequence", sequence}, {"time_s", time}, {"value", value}, {"sd", sd}, {"curve", json()}};
    const Result<MemoryBlock> block = MemoryBlock::map(growth_bytes(series.samples.size(), {}));
    if (block.ok()) {
        Arena arena{block.value().bytes()};
        if (const Result<GrowthFit> fit = fit_growth(series.samples, {}, arena); fit.ok()) {
            told["curve"] = curve_of(fit.value());
            for (std::size_t i = 0; i < outlier.size(); ++i)
                outlier[i] = fit.value().samples[i].use == SampleFit::Use::kOutlier ? '1' : '0';
        }
    }
    told["outlier"] = outlier;
    return told;
}

} // namespace

GrowthJob::GrowthJob(std::shared_ptr<const ViewBoard> board)
    : board_(std::move(board)), order_(widely_first(board_->slots()))
{
}

GrowthJob::~GrowthJob()
{
    ended_ = true;
    if (thread_.joinable())
        thread_.join();
}

void GrowthJob::begin()
{
    const std::scoped_lock lock(guard_);
    if (!std::exchange(begun_, true))
        thread_ = std::thread([this] { work(); });
}

void GrowthJob::finish()
{
    begin();
    if (thread_.joinable())
        thread_.join();
}

void GrowthJob::work()
{
    for (const SlotRow* row : order_) {
        if (ended_ || StopRequest::asked())
            return;
        MeasuredSlot slot;
        slot.row = row;
        const Status done = [&]() -> Status {
            const std::string file = TRY(board_->read(*row, "cloud.drc"));
            const CloudOnDisk cloud =
                TRY(CloudOnDisk::decode(std::as_bytes(std::span{file.data(), file.size()}), "cloud.drc"));
            const PlantWork plants = TRY(PlantWork::make(cloud.cloud(), "cloud.drc"));
            slot.plants.assign(plants.traits().plants.begin(), plants.traits().plants.end());
            for (const PlantTraits& plant : slot.plants)
                slot.names.push_back(plants.plant_name(plant.plant));
            return {};
        }();
        const std::scoped_lock lock(guard_);
        ++tried_;
        if (done.ok())
            measured_.push_back(std::move(slot));
    }
}

json GrowthJob::curves()
{
    begin();
    std::vector<MeasuredSlot> measured;
    std::size_t tried = 0;
    {
        const std::scoped_lock lock(guard_);
        measured = measured_;
        tried = tried_;
    }
    std::ranges::sort(measured, {}, [](const MeasuredSlot& slot) { return slot.row->sequence; });
    std::map<std::string, std::map<const PlantTrait*, Series>> plants;
    for (const MeasuredSlot& slot : measured)
        for (std::size_t i = 0; i < slot.plants.size(); ++i)
            for (const PlantTrait& trait : kTraits) {
                Series& series = plants[slot.names[i]][&trait];
                series.rows.push_back(slot.row);
                series.samples.push_back({day_of(*slot.row), std::nan(""), slot.plants[i].*trait.value});
            }
    json traits = json::array(), told = json::array();
    for (const PlantTrait& trait : kTraits)
        traits.push_back({{"key", trait.key}, {"name", trait.name}, {"unit", trait.unit}, {"scale", trait.scale}});
    for (const auto& [name, of_trait] : plants) {
        json series;
        for (const auto& [trait, samples] : of_trait)
            series[trait->key] = series_json(samples);
        told.push_back({{"name", name}, {"series", series}});
    }
    return {{"done", tried}, {"of", order_.size()}, {"traits", traits}, {"plants", told}};
}

} // namespace dicot::app
