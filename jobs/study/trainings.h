// Which networks a study trains, on which data.
#pragma once

#include <vector>

#include "jobs/study/folder.h"
#include "jobs/study/noise_trainings.h"
#include "train/training_table.h"

namespace strut {

/// The data of the noise section, which must be planned: snapshots of the main number of cases with
/// each preload, and the windows. Throws InputError.
NoiseStudyData open_noise_data(const StudyFolder& folder, const StudyRequest& request);

/// All cells with every seed, then those with noise. Throws InputError.
std::vector<TableTraining> list_study_trainings(const StudyFolder& folder,
                                                const StudyRequest& request);

}  // namespace strut
