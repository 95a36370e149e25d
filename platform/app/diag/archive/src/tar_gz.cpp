#include "dicot/archive/tar_gz.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <span>

namespace dicot::app {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::size_t kMostContent = (std::size_t{1} << 30) - 1; ///< far below what 11 octal digits hold

/// ustar's header: fields at fixed places, numbers in octal.
class Header
{
public:
    Header(const std::string& name, std::size_t bytes, std::int64_t time_s)
    {
        text(0, name);
        octal(100, 8, 0644);
        octal(108, 8, 0);
        octal(116, 8, 0);
        octal(124, 12, bytes);
        octal(136, 12, static_cast<std::uint64_t>(std::clamp(time_s, std::int64_t{0}, std::int64_t{0xFFFF'FFFF})));
        text(148, "        "); // the sum counts itself as blanks
        bytes_[156] = '0';
        std::memcpy(bytes_.data() + 257, "ustar\00000", 8);
        text(265, "root");
        text(297, "root");
        unsigned sum = 0;
        for (const char byte : bytes_)
            sum += static_cast<unsigned char>(byte);
        octal(148, 7, sum);
    }
    std::string_view view() const { return {bytes_.data(), bytes_.size()}; }

private:
    void text(std::size_t at, std::string_view value)
    {
        std::copy(value.begin(), value.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    void octal(std::size_t at, std::size_t width, std::uint64_t value)
    {
        bytes_[at + width - 1] = '\0';
        for (std::size_t digit = width - 1; digit-- > 0; value /= 8)
            bytes_[at + digit] = static_cast<char>('0' + value % 8);
    }

    std::array<char, kBlock> bytes_{};
};

bool is_safe(const std::string& name)
{
    return !name.empty() && name.size() <= TarGz::kMostName && name.front() != '/' && name.back() != '/' &&
           ("/" + name + "/").find("/../") == std::string::npos && name.find('\0') == std::string::npos;
}

} // namespace

struct TarGz::Squeeze
{
    z_stream stream{};
    bool open = false;

    Squeeze() = default;
    Squeeze(const Squeeze&) = delete;
    Squeeze& operator=(const Squeeze&) = delete;
    ~Squeeze()
    {
        if (open)
            (void)deflateEnd(&stream);
    }
};

TarGz::TarGz() = default;
TarGz::~TarGz() = default;

Status TarGz::open(const char* path, std::int64_t time_s)
{
    time_s_ = time_s;
    squeeze_ = std::make_unique<Squeeze>();
    constexpr int kWindowAndGzip = 15 + 16, kUsualMemory = 8;
    squeeze_->open = deflateInit2(&squeeze_->stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kWindowAndGzip, kUsualMemory,
                                  Z_DEFAULT_STRATEGY) == Z_OK;
    if (!squeeze_->open)
        return failure(Fault::kOsError, "%s: there is no memory to compress", path);
    return file_.open(path);
}

Status TarGz::put(std::string_view bytes, bool last)
{
    z_stream& stream = squeeze_->stream;
    // zlib does not write there, but does not say so.
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::array<Bytef, 4096> out;
    do {
        stream.next_out = out.data();
        stream.avail_out = static_cast<uInt>(out.size());
        if (deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH) == Z_STREAM_ERROR)
            return failure(Fault::kSoftware, "%s: zlib lost its state", file_.path());
        TRY(file_.write(out.data(), out.size() - stream.avail_out));
    } while (stream.avail_out == 0);
    return {};
}

Status TarGz::add(const std::string& name, std::string_view content)
{
    if (!is_safe(name) || content.size() > kMostContent)
        return failure(Fault::kSoftware, "%s: '%s' is no member of an archive", file_.path(), name.c_str());
    TRY(put(Header(name, content.size(), time_s_).view()));
    TRY(put(content));
    const std::array<char, kBlock> zeros{};
    return put({zeros.data(), (kBlock - content.size() % kBlock) % kBlock});
}

Status TarGz::commit()
{
    const std::array<char, 2 * kBlock> zeros{};
    TRY(put({zeros.data(), zeros.size()}, true));
    return file_.commit();
}

} // namespace dicot::app
