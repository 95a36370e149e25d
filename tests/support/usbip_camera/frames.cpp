#include "frames.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <tuple>

namespace dicot::usbip {

namespace {

Result<std::span<const std::uint8_t>> mapped(const std::string& path)
{
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat seen = {};
    if (file < 0 || ::fstat(file, &seen) != 0) {
        if (file >= 0)
            ::close(file);
        return failure(Fault::kNoInput, "%s: cannot be read", path.c_str());
    }
    const auto size = static_cast<std::size_t>(seen.st_size);
    void* bytes = size == 0 ? MAP_FAILED : ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    ::close(file);
    if (bytes == MAP_FAILED)
        return failure(Fault::kBadData, "%s: is empty or cannot be mapped", path.c_str());
    return std::span(static_cast<const std::uint8_t*>(bytes), size);
}

} // namespace

FrameFolder::~FrameFolder()
{
    for (const Series& series : series_)
        for (const auto& frame : series.frames)
            ::munmap(const_cast<std::uint8_t*>(frame.data()), frame.size());
}

Status FrameFolder::open(const std::string& path)
{
    std::error_code error;
    std::vector<std::string> names;
    for (auto entry = std::filesystem::directory_iterator(path, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
        names.push_back(entry->path().filename().string());
    if (error)
        return failure(Fault::kNoInput, "%s: is no folder that can be read", path.c_str());
    std::sort(names.begin(), names.end());
    for (const std::string& name : names)
        TRY(add(path, name));
    if (series_.empty())
        return failure(Fault::kNoInput, "%s: holds no frame such as 640x480_0.yuyv or 640x480_0.jpg", path.c_str());
    std::sort(series_.begin(), series_.end(), [](const Series& a, const Series& b) {
        return std::tuple(a.pixels, a.width, a.height) < std::tuple(b.pixels, b.width, b.height);
    });
    return {};
}

Status FrameFolder::add(const std::string& path, const std::string& name)
{
    Series found;
    int end = 0;
    if (std::sscanf(name.c_str(), "%5dx%5d_%n", &found.width, &found.height, &end) != 2 || end == 0 ||
        found.width < 1 || found.height < 1)
        return {};
    if (name.ends_with(".jpg"))
        found.pixels = Pixels::kMjpeg;
    else if (!name.ends_with(".yuyv"))
        return {};
    const std::string file = path + "/" + name;
    const std::span<const std::uint8_t> frame = TRY(mapped(file));
    auto series = std::find_if(series_.begin(), series_.end(), [&](const Series& one) {
        return one.pixels == found.pixels && one.width == found.width && one.height == found.height;
    });
    if (series == series_.end())
        series = series_.insert(series, found);
    series->frames.push_back(frame);
    if (found.pixels == Pixels::kYuyv &&
        frame.size() != static_cast<std::size_t>(found.width) * static_cast<std::size_t>(found.height) * 2)
        return failure(Fault::kBadData, "%s: has %zu bytes; YUYV of this size has width x height x 2", file.c_str(),
                       frame.size());
    return {};
}

std::vector<Format> FrameFolder::formats() const
{
    std::vector<Format> formats;
    for (const Series& series : series_) {
        if (formats.empty() || formats.back().pixels != series.pixels)
            formats.push_back({series.pixels, {}});
        const auto bytes = static_cast<std::uint32_t>(series.width) * static_cast<std::uint32_t>(series.height) * 2;
        std::uint32_t largest = series.pixels == Pixels::kYuyv ? bytes : 0;
        for (const auto& frame : series.frames)
            largest = std::max(largest, static_cast<std::uint32_t>(frame.size()));
        formats.back().modes.push_back({series.width, series.height, largest});
    }
    return formats;
}

const FrameFolder::Series* FrameFolder::series(std::size_t format, std::size_t mode) const
{
    std::size_t at_format = 0;
    std::size_t at_mode = 0;
    for (std::size_t i = 0; i < series_.size(); ++i) {
        if (i > 0) {
            const bool same = series_[i].pixels == series_[i - 1].pixels;
            at_mode = same ? at_mode + 1 : 0;
            at_format += same ? 0 : 1;
        }
        if (at_format == format && at_mode == mode)
            return &series_[i];
    }
    return nullptr;
}

std::span<const std::uint8_t> FrameFolder::frame(std::size_t format, std::size_t mode, std::uint64_t number) const
{
    const Series* found = series(format, mode);
    if (found == nullptr)
        return {};
    return found->frames[static_cast<std::size_t>(number % found->frames.size())];
}

} // namespace dicot::usbip
