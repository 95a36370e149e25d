// Stands in for libFuzzer where it is not linked: every file of a folder, whole, cut short and mangled.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

int replay(const std::filesystem::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    const Bytes whole{std::istreambuf_iterator<char>(stream), {}};
    int runs = 0;
    const auto feed = [&](const Bytes& bytes) {
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
        ++runs;
    };
    feed(whole);
    for (std::size_t part = 1; part < 16; ++part)
        feed(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(whole.size() * part / 16)));
    // The engine's numbers are fixed by the standard; distributions are not, so none is used.
    std::mt19937 random{static_cast<std::uint32_t>(whole.size())};
    for (int i = 0; i < 64 && !whole.empty(); ++i) {
        Bytes mangled = whole;
        for (int k = 0; k <= i % 4; ++k)
            mangled[random() % std::min<std::size_t>(mangled.size(), i % 2 == 0 ? 64 : SIZE_MAX)] =
                static_cast<std::uint8_t>(random());
        feed(mangled);
    }
    return runs;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s CORPUS_FOLDER\n", argv[0]);
        return 64;
    }
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
        if (entry.is_regular_file())
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    int runs = 0;
    for (const auto& path : paths) {
        std::printf("%s\n", path.filename().c_str());
        std::fflush(stdout); // so that a crash names its file
        runs += replay(path);
    }
    std::printf("%zu files, %d inputs\n", paths.size(), runs);
    return paths.empty() ? 1 : 0;
}
