// A card in a reader, a copied folder, another archive: one board's folder as a source. Nothing is written to it.
#pragma once

#include "dicot/medium/medium.h"
#include "dicot/pull_archive/pull_source.h"

#include <memory>
#include <string>

namespace dicot {

/// The medium's root is the board's folder, with a catalogue or without, whole or half copied. `device`: the board's
/// name; `where`: for people. Snapshots in their place alone are offered, with the digest of SHA256SUMS where it can be
/// read; pulled are those that bear the store's mark. Marks and time are refused (Fault::kUsage).
Result<std::unique_ptr<PullSource>> open_folder_source(std::unique_ptr<Medium> medium, std::string device,
                                                       std::string where);

} // namespace dicot
