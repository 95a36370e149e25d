// What months alone take: every byte of memory that `dicot run` will ever have, found before it takes any.
#pragma once

#include "../cameras/camera_memory.h"
#include "../config/config.h"
#include "../process_bench.h"

#include "dicot/base/status.h"

#include <array>
#include <cstddef>

namespace dicot::app {

/// What this process has before it takes any of the below: to be asked first.
struct BareProcess
{
    std::size_t resident_bytes = 0;
    std::size_t address_bytes = 0;
    /// Fault::kOsError: /proc is not there.
    static Result<BareProcess> measure();
};

/// In bytes, each for the most that it can become.
struct RunBudget
{
    /// Resident is what the pages take of the board's memory, mapped what RLIMIT_AS counts.
    struct Part
    {
        const char* name; ///< for a person
        const char* key;  ///< for a program
        std::size_t resident, mapped;
    };

    Part program{"program, libraries, stacks", "program", 0, 0};
    Part clouds{"clouds: tables, matcher, compressor", "clouds", 0, 0};
    Part store{"store: catalogue, reading of records", "store", 0, 0};
    Part cameras{"cameras: frames", "cameras", 0, 0};
    Part office{"office: records, names, cameras' objects", "office", 0, 0};
    Part libraries{"libraries: what malloc serves", "libraries", 0, 0};

    std::size_t pages = 0; ///< of cameras and store: what MemoryBlock::map() serves after the seal

    std::size_t resident() const;
    std::size_t mapped() const;
    std::array<Part, 6> parts() const { return {program, clouds, store, cameras, office, libraries}; }
};

/// `clouds` as SnapshotBench has it, with `threads` workers. Fault::kConfig: it is more than run.most_memory_mib; the
/// sentence says both.
Result<RunBudget> run_budget(const Config& config, const BareProcess& bare, const CameraMemory& cameras,
                             const ProcessBudget& clouds, int threads);

} // namespace dicot::app
