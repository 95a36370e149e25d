#include "slot_record.h"

#include "../config_json.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/host.h"
#include "dicot/os/process_memory.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace dicot::app {

using nlohmann::json;

json clock_record(const ClockReading& clock)
{
    return {{"trust", name_of(clock.trust)},
            {"max_error_ms", clock.most_error_us ? json(static_cast<double>(*clock.most_error_us) / 1000) : json()},
            {"why", clock.why}};
}

json plan_record(const SlotNotes& notes)
{
    json record = {{"why", notes.why.view()}};
    if (!notes.woken)
        return record;
    const Woken& woken = *notes.woken;
    record["begin"] = utc_text(notes.begun_us).view();
    record["woken"] = {{"by", name_of(woken.reason)},
                       {"rest", name_of(woken.way)},
                       {"asleep_s", static_cast<double>(woken.asleep_us) * 1e-6},
                       {"interrupt", woken.woken_by.view()},
                       {"trouble", woken.trouble.view()}};
    return record;
}

json temperatures_record()
{
    json record = json::object();
    for (const Temperature& one : read_temperatures())
        record[one.name] = std::round(one.celsius * 10) / 10;
    return record;
}

json parameters_record(const Config& config)
{
    return config_values(config);
}

json start_record(const StartReport& report)
{
    return {{"finished", report.finished},
            {"interrupted", report.interrupted},
            {"left_over", report.left_over},
            {"rows_added", report.rows_added},
            {"catalogue_new", report.catalogue_new}};
}

json memory_record(std::size_t arena_bytes)
{
    const Result<ProcessMemory> memory = process_memory();
    return {{"arena_bytes", arena_bytes},
            {"peak_resident_bytes", memory.ok() ? json(memory.value().peak_bytes) : json()}};
}

void files_into(json& record, const Store& store)
{
    json digests = json::object();
    std::uint64_t bytes = 0;
    store.for_each_added([&](const Store::Added& added) {
        digests[added.name.c_str()] = added.sha256.c_str();
        bytes += added.bytes;
    });
    record["digests"] = digests;
    record["bytes_written"] = bytes;
}

} // namespace dicot::app
