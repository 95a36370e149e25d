#include "dicot/shelf/snapshot_shelf.h"
