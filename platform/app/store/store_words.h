// The words by which a command is told which stores are meant, and where these are.
#pragma once

#include "../config_words.h"

#include "dicot/store/store.h"

#include <string>
#include <vector>

namespace dicot::app {

/// The folder of one board.
struct DeviceFolder
{
    std::string device; ///< its name; whatever the folder is called
    std::string path;
};

/// A folder of which nobody knows whether it is a board's.
struct UnreadFolder
{
    std::string name;
    Status why; ///< Fault::kNoInput
};

struct FoundStores
{
    OutputConfig output;
    std::string root; ///< where was looked
    std::vector<DeviceFolder> devices;
    std::vector<UnreadFolder> unread;
};

struct StoreWords
{
    ConfigWords config;
    std::string root;   ///< empty: output.folder
    std::string device; ///< empty: all

    void add_to(CLI::App& command);
    /// The boards' folders in the root, by name, or the root itself where it is one. Fault::kNoInput: there is no such
    /// folder, it cannot be read, no board in it has that name. Errors: those of load_config().
    Result<FoundStores> find() const;
};

/// Whether snapshots of one board lie in this folder: it has a catalogue, folders named by days, or what a store makes
/// for its work. Links are not followed. Fault::kNoInput: it cannot be read.
Result<bool> is_device_folder(const std::string& path);

/// Takes "17" and "000017" for a number of 1 to kMaxSequence, for a slot or for so many of them.
CLI::Validator slot_number();

StoreRules rules_of(const OutputConfig& output);

/// When the newest slot began, by the clock of then; none: there is no slot.
Result<std::optional<std::int64_t>> newest_time(Catalogue& catalogue);

/// A store that is only read. The catalogue is that of the file, or made of the folders.
struct ReadStore
{
    std::unique_ptr<Medium> medium;
    std::unique_ptr<Catalogue> catalogue;

    /// Errors: those of open_disk_medium() and read_catalogue().
    static Result<ReadStore> open(const std::string& path);
};

/// Whether a ReadStore of this folder knows all of its days: without a catalogue, a day that cannot be read is not
/// told. Fault::kIoError: there is one.
Status all_days_told(const std::string& path);

/// A store that is written to.
struct WrittenStore
{
    std::unique_ptr<Medium> medium;
    std::unique_ptr<Store> store; ///< goes first

    /// Errors: those of open_disk_medium() and Store::open().
    static Result<WrittenStore> open(const std::string& path, const StoreRules& rules);
};

} // namespace dicot::app
