#include "jobs/compare/curves.h"

#include <algorithm>
#include <iterator>

namespace strut {
namespace {

constexpr std::size_t kMostPoints = 2500;

std::vector<ModelCurves> keep_simulated(const std::vector<ModelCurves>& models) {
  std::vector<ModelCurves> kept;
  std::copy_if(models.begin(), models.end(), std::back_inserter(kept),
               [](const ModelCurves& model) { return model.is_simulated(); });
  return kept;
}

const std::vector<double>& get_curve(const ModelCurves& model, int channel) {
  return model.evaluation->curves.channel[static_cast<std::size_t>(channel)];
}

/// time, measured, models, residuals of the models
std::vector<std::vector<double>> make_curve_rows(const std::vector<double>& times,
                                                 const MeasuredChannel& c,
                                                 const std::vector<ModelCurves>& models) {
  const std::size_t stride = choose_stride(times.size());
  std::vector<std::vector<double>> rows;
  rows.reserve(times.size() / stride + 1);
  for (std::size_t t = 0; t < times.size(); t += stride) {
    std::vector<double> row = {times[t], c.values[t]};
    for (const ModelCurves& model : models) row.push_back(get_curve(model, c.channel)[t]);
    for (const ModelCurves& model : models) {
      row.push_back(c.values[t] - get_curve(model, c.channel)[t]);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Models from a column of the block on, as what follows "plot".
std::string plot_models(const std::string& block, std::size_t column,
                        const std::vector<ModelCurves>& models, bool has_titles) {
  std::string text;
  for (const ModelCurves& model : models) {
    text += (text.empty() ? "" : ", ") + block + " using 1:" + std::to_string(column++) +
            " with lines linetype " + std::to_string(model.line_type) +
            (has_titles ? " title '" + model.name + "'" : " notitle");
  }
  return text;
}

}  // namespace

std::string make_run_name(const CampaignData& data, std::size_t run) {
  std::string name =
      "run_" + std::to_string(run + 1) + "_" + data.campaign.runs[run].file.stem().string();
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-') c = '_';
  }
  return name;
}

std::size_t choose_stride(std::size_t count) { return 1 + count / kMostPoints; }

Figure make_curve_figure(const CampaignData& data, std::size_t run,
                         const std::vector<ModelCurves>& models) {
  const std::vector<ModelCurves> simulated = keep_simulated(models);
  const std::vector<MeasuredChannel>& channels = data.channels(run);
  Figure figure{make_run_name(data, run) + "_time", 1000,
                static_cast<int>(360 * channels.size() + 60), ""};
  std::string& text = figure.commands;
  text = "set multiplot layout " + std::to_string(2 * channels.size()) +
         ",1 margins 0.1,0.97,0.08,0.96 spacing 0.05\n"
         "set grid\nset key outside above horizontal\nset format x ''\n";
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const ChannelInfo& info = data.info(channels[k].channel);
    const std::string block = "$channel" + std::to_string(k);
    text += make_data(block.substr(1), make_curve_rows(data.times(run), channels[k], simulated));
    text += "set ylabel " + quote_figure_text(make_words(info.name) + " [" + info.unit + "]") +
            "\nplot " + block + " using 1:2 with lines linetype 1 title 'measured', " +
            plot_models(block, 3, simulated, true) + "\nunset key\n";
    if (k + 1 == channels.size()) text += "set format x '%g'\nset xlabel 'time [s]'\n";
    text += "set ylabel 'residual [" + info.unit + "]'\nplot " +
            plot_models(block, 3 + simulated.size(), simulated, false) + "\n";
  }
  text += "unset multiplot\n";
  return figure;
}

std::vector<CsvColumn> make_curve_columns(const CampaignData& data, std::size_t run,
                                          const std::vector<ModelCurves>& models) {
  std::vector<CsvColumn> columns = {{"time", "s", data.times(run)}};
  for (const MeasuredChannel& c : data.channels(run)) {
    const ChannelInfo& info = data.info(c.channel);
    columns.push_back({info.name, info.unit, c.values});
    for (const ModelCurves& model : keep_simulated(models)) {
      columns.push_back({info.name + "_" + model.name, info.unit, get_curve(model, c.channel)});
    }
  }
  return columns;
}

}  // namespace strut
