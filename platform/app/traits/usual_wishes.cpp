#include "usual_wishes.h"

#include "../plant/plant_places.h"

namespace dicot::app {

Result<TraitsWishes> usual_wishes(const std::string& places)
{
    constexpr std::size_t kShortDigest = 16; // of its 64 digits
    TraitsWishes wishes;
    wishes.cache_folder = usual_cache_folder();
    if (!places.empty()) {
        wishes.places = TRY(read_plant_places(places));
        wishes.cache_name = "-" + TRY(digest_of_file(places)).substr(0, kShortDigest);
    }
    wishes.maker = TRY(cache_maker());
    return wishes;
}

} // namespace dicot::app
