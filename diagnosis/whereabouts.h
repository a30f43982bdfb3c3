// Where the gap lies: the squared residual that geometry leaves, shared out by joint, set, region
// of the cell and time.
#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis/view.h"

namespace selfcal {

/// By joint: what effects at it explain when all joints may have some. By set, region and time:
/// what stands there beyond the noise.
Where whereabouts(const View& view, const Bench& bench, const DataSet& data);

}  // namespace selfcal
