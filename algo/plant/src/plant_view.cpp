#include "dicot/plant/plant_view.h"
