// What is known of the gadget without any right.
#pragma once

#include "server_page.h"

#include "dicot/gadget/usb_gadget.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

struct GadgetStatus
{
    std::string controller; ///< that the gadget is bound to, or would be; empty: this board has none
    std::string why;        ///< there is none
    bool prepared = false;
    bool bound = false;
    std::string state, speed; ///< of the controller, as the kernel says
    std::optional<SeenServer> server;
    std::uint64_t resident_bytes = 0; ///< of the server; 0: not known
};

GadgetStatus gadget_status(const GadgetPlaces& places, const std::string& wanted_controller);
nlohmann::json gadget_json(const GadgetStatus& status);
std::string gadget_text(const GadgetStatus& status);

} // namespace dicot::app
