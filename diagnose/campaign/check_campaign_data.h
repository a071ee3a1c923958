// What makes a campaign's data unusable though every file can be read.
#pragma once

namespace strut {

struct CampaignData;

/// Throws InputError, naming the file, where
///  - the sampling rate is too low for what the model can do: below 4 samples a period of its
///    fastest mode (8 are wanted), cars below 50 Hz (100 are wanted); it says so if the clock may
///    be in another unit;
///  - nothing drives a rig: all inputs constant;
///  - a channel's spread is outside of what such a quantity can have, or differs more than 300-fold
///    from that of the nominal model in the same run: its unit is suspected.
/// Rates between what is needed and what is wanted become notes.
void check_campaign_data(CampaignData& data);

}  // namespace strut
