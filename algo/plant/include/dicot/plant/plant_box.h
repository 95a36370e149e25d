// Several plants in one view, told apart by where they stand.
#pragma once

namespace dicot {

/// A box in the ground frame, mm: x right, y away from the cameras, z up. A point on a face is inside.
struct PlantBox
{
    double min_mm[3] = {0, 0, 0};
    double max_mm[3] = {0, 0, 0};

    bool holds(const double (&at_mm)[3]) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (!(at_mm[axis] >= min_mm[axis] && at_mm[axis] <= max_mm[axis]))
                return false;
        return true;
    }
};

} // namespace dicot
