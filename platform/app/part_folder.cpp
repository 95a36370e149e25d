#include "part_folder.h"

#include "output_folder.h"

#include <filesystem>
#include <unistd.h>

namespace dicot::app {

namespace fs = std::filesystem;

PartFolder::~PartFolder()
{
    std::error_code ignored;
    if (!part_.empty())
        fs::remove_all(part_, ignored);
}

Status PartFolder::open(const std::string& around, const std::string& name)
{
    TRY(make_folder(around));
    const std::string part = around + "/." + name + "." + std::to_string(::getpid()) + ".part";
    std::error_code error;
    if (!fs::create_directory(part, error))
        return failure(Fault::kCannotCreate, "%s: %s", part.c_str(),
                       error ? error.message().c_str() : "it is there already");
    part_ = part;
    target_ = around + "/" + name;
    for (int k = 2; fs::exists(target_, error); ++k)
        target_ = around + "/" + name + "_" + std::to_string(k);
    return {};
}

Status PartFolder::commit()
{
    std::error_code error;
    fs::rename(part_, target_, error);
    if (error)
        return failure(Fault::kIoError, "%s: %s", target_.c_str(), error.message().c_str());
    part_.clear();
    return {};
}

} // namespace dicot::app
