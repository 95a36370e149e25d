#include "rig_source.h"

#include "rectify_rig.h"

#include "dicot/os/shown_path.h"
#include "dicot/rig/opencv_files.h"
#include "dicot/rig/rig_id.h"
#include "dicot/rig/ros_files.h"

#include <cstdio>
#include <optional>
#include <sys/stat.h>

namespace dicot::app {

namespace {

RigFile truly_named(RigFile rig, const std::string& path)
{
    if (id_matches(rig))
        return rig;
    const std::string said = rig.id;
    set_id(rig);
    rig.quality = std::nullopt;
    std::fprintf(stderr,
                 "dicot: %s: its numbers were changed after it was named %s: they are %s, and its verdict is not "
                 "theirs\n",
                 shown_path(path.c_str()), said.c_str(), rig.id);
    return rig;
}

Result<RigFile> read_any(const std::string& path, const RigHints& hints)
{
    if (!is_folder(path))
        return truly_named(TRY(read_rig_file(path.c_str(), hints)), path);
    if (holds_opencv_files(path))
        return read_opencv_files(path, hints);
    if (hints.width != 0 || hints.mm_per_unit != 0)
        return failure(Fault::kUsage,
                       "%s: camera_info says the size and the unit itself: leave --size and --unit-mm out",
                       shown_path(path.c_str()));
    return read_ros_files(path);
}

} // namespace

Result<RigFile> read_rig_for_use(const std::string& path)
{
    return truly_named(TRY(read_rig_file(path.c_str())), path);
}

bool is_folder(const std::string& path)
{
    struct stat there
    {
    };
    return ::stat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode);
}

Result<RigFile> read_whole_rig(const std::string& path, const RigHints& hints)
{
    RigFile rig = TRY(read_any(path, hints));
    const bool rectified = rig.left.rectifying && rig.right.rectifying && rig.left.projection && rig.right.projection;
    if (!rectified && describes_cameras(rig)) {
        const StereoRig stereo = TRY(stereo_rig_of(rig, path.c_str()));
        set_rectification(rig, TRY(rectify(stereo, kCrop, path.c_str())));
    }
    return rig;
}

} // namespace dicot::app
