// Checks of a campaign's data that can be read but not used.
#pragma once

namespace strut {

struct CampaignData;

/// Throws InputError, with the file, where
///  - the sampling rate is too low for the model: below 4 samples a period of its fastest mode (8
///    are recommended), for cars below 50 Hz (100 are recommended); with a hint if the clock may be
///    in another unit;
///  - a rig is not driven: all inputs are constant;
///  - a channel's spread is implausible for such a quantity, or differs more than 300-fold from
///  that
///    of the nominal model in the same run: its unit may be wrong.
/// Adds a note for a rate between the required and the recommended one.
void check_campaign_data(CampaignData& data);

}  // namespace strut
