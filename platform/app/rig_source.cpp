#include "rig_source.h"

#include "rectify_rig.h"

#include "dicot/rig/ros_files.h"

#include <sys/stat.h>

namespace dicot::app {

bool is_folder(const std::string& path)
{
    struct stat there
    {
    };
    return ::stat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode);
}

Result<RigFile> read_whole_rig(const std::string& path)
{
    RigFile rig = TRY(is_folder(path) ? read_ros_files(path) : read_rig_file(path.c_str()));
    const bool rectified = rig.left.rectifying && rig.right.rectifying && rig.left.projection && rig.right.projection;
    if (!rectified && describes_cameras(rig)) {
        const StereoRig stereo = TRY(stereo_rig_of(rig, path.c_str()));
        set_rectification(rig, TRY(rectify(stereo, kCrop, path.c_str())));
    }
    return rig;
}

} // namespace dicot::app
