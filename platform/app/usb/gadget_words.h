// What a computer is told of this board, and where the gadget's pieces come from.
#pragma once

#include "../config/config.h"

#include "dicot/gadget/usb_gadget.h"
#include "dicot/mtp/responder.h"

#include <string>

namespace dicot::app {

/// usb.serial, or one made of the board's own number (of its device tree: boards of one card image share the
/// machine-id), or of the machine-id. Fault::kConfig: there is none of these.
Result<std::string> serial_for(const UsbConfig& usb, const char* board_number_file = "/proc/device-tree/serial-number",
                               const char* machine_id_file = "/etc/machine-id");
/// "dicot NAME", of `version` "0.1.0" 0x0010.
GadgetWords gadget_words(const std::string& device, const std::string& serial, const char* version);
mtp::DeviceWords device_words(const std::string& device, const std::string& serial, const char* version);

} // namespace dicot::app
