#include "dicot/rig/opencv_files.h"

#include "rig_reader.h"

#include <unistd.h>

namespace dicot {

bool holds_opencv_files(const std::string& folder)
{
    return ::access((folder + "/intrinsics.yml").c_str(), F_OK) == 0;
}

Result<RigFile> read_opencv_files(const std::string& folder, const RigHints& hints)
{
    RigReader reader{hints};
    TRY(reader.take_file((folder + "/intrinsics.yml").c_str()));
    TRY(reader.take_file((folder + "/extrinsics.yml").c_str()));
    return reader.finish(folder.c_str());
}

} // namespace dicot
