// Checks a campaign's data, which may be readable and yet unusable.
#pragma once

namespace strut {

struct CampaignData;

/// Throws InputError, with the file, where
///  - the sampling rate is too low for the model: below 4 samples a period of its fastest mode (8
///    are recommended), for cars below 50 Hz (100 are recommended); with a hint if the clock may be
///    in another unit;
///  - a rig is not driven: all inputs are constant;
///  - a channel's spread is implausible for its quantity, or differs from that of the nominal model
///    in the same run by a factor above 300: its unit may be wrong.
/// Adds a note for a rate between the required and the recommended one.
void check_campaign_data(CampaignData& data);

}  // namespace strut
