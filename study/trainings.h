// The trainings of a study, each with its data.
#pragma once

#include <vector>

#include "study/folder.h"
#include "study/noise/trainings.h"
#include "train/training_table.h"

namespace strut {

/// The data of the noise section: snapshots of the main number of cases with each preload, and the
/// windows. Their sweeps must be planned. Throws InputError.
NoiseStudyData open_noise_data(const StudyFolder& folder, const StudyRequest& request);

/// All cells with every seed, then the trainings with noise. Throws InputError.
std::vector<TableTraining> list_study_trainings(const StudyFolder& folder,
                                                const StudyRequest& request);

}  // namespace strut
