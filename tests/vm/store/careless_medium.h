// A card whose syncs do nothing, or those of folders alone: what a store on it acknowledges need not outlive the power.
#pragma once

#include "passing_medium.h"

namespace dicot {

class CarelessMedium final : public test::PassingMedium
{
public:
    CarelessMedium(Medium& card, bool syncs_files) : PassingMedium(card), syncs_files_(syncs_files) {}

    Errno sync_all() override { return syncs_files_ ? PassingMedium::sync_all() : Errno{}; }
    Errno sync_folder(const char*) override { return {}; }

private:
    bool syncs_files_;
};

} // namespace dicot
