// Draws the charts of a report: each div.chart has a script element with the JSON of make_plotly().
// Once all charts are drawn or have failed, the body's data-charts is "DRAWN/TOTAL".
"use strict";

const strutCharts = [];
const darkMode = window.matchMedia("(prefers-color-scheme: dark)");

// Colors on paper, which is white even if the screen is dark. During "beforeprint" the computed
// styles are still those of the screen.
const paperColors = {"--ink": "#1b1f24", "--line": "#d0d7de", "--soft": "#57606a", "--paper": "#ffffff"};
// Of charts on a dark page: lighter than on paper, in the same order of hues.
const darkColors = {"#0072B2": "#4aa3df", "#D55E00": "#f0803c", "#009E73": "#2fc095", "#CC79A7": "#dc93bb"};
const paperWidth = 980;  // px
const buttonHeight = 30;  // px above the legend
const minWidthRatio = 0.8;  // to a chart's nominal width; on a narrower page panels are below each other
let isForPaper = false;

function readColor(name) {
  if (isForPaper) return paperColors[name];
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

// Axes and texts of a chart in the colors of the page.
function makeTemplate() {
  const ink = readColor("--ink");
  const line = readColor("--line");
  const axis = {gridcolor: line, zerolinecolor: line, linecolor: ink, showline: true, ticks: "outside",
                autotickangles: [0, -30, -90], automargin: false, exponentformat: "power", minexponent: 5, title: {standoff: 8, font: {size: 12}}};
  return {layout: {
    font: {color: ink, size: 13, family: "system-ui, 'DejaVu Sans', Arial, sans-serif"},
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", xaxis: axis, yaxis: axis,
    modebar: {bgcolor: readColor("--paper"), color: readColor("--soft"), activecolor: ink},
    legend: {itemsizing: "constant", itemwidth: 40},  // small points would be invisible, dashes alike
    hoverlabel: {namelength: -1}}};
}

// Copies a trace or layout with the color "ink" replaced by that of the page, and with lighter colors on a
// dark one. Names are text: plotly.js would take what looks like HTML for it.
function paint(value, ink) {
  if (value === "ink") return ink;
  if (typeof value === "string" && value.startsWith("#")) {
    const isDark = darkMode.matches && !isForPaper;
    return isDark && darkColors[value.slice(0, 7)] ? darkColors[value.slice(0, 7)] + value.slice(7) : value;
  }
  if (typeof value === "string") return value.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replace(/\^([23])(?!\d)/g, (match, digit) => digit === "2" ? "\u00b2" : "\u00b3");
  if (Array.isArray(value)) {
    return value.some((item) => typeof item !== "number") ? value.map((v) => paint(v, ink)) : value;
  }
  if (value === null || typeof value !== "object") return value;
  return Object.fromEntries(Object.entries(value).map(([key, v]) => [key, paint(v, ink)]));
}

function quoteCsv(text) {
  return '"' + String(text).replaceAll('"', '""') + '"';
}

// The numbers of a chart as drawn, one line per point; whiskers as distances below and above y.
function makeCsv(chart) {
  const lines = ["panel,series,category,x,y,value,below,above"];
  for (const trace of chart.data) {
    const names = chart.layout[trace.xaxis.replace("x", "xaxis")].ticktext;
    const hasCategory = trace.type !== "scatter" || trace.mode === "markers";
    const values = trace.marker?.showscale && trace.marker.color;
    const columns = [trace.x, trace.y, values, trace.error_y?.arrayminus, trace.error_y?.array];
    trace.x.forEach((x, i) => {
      const category = hasCategory && names?.[Math.round(x) - 1];
      const words = [trace.meta, trace.name, category || ""].map(quoteCsv);
      lines.push([...words, ...columns.map((column) => column?.[i])].join(","));
    });
  }
  return lines.join("\n") + "\n";
}

function saveText(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], {type: "text/csv"}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);  // some browsers start saving late
}

function makeConfig(chart) {
  const icon = {width: 24, height: 24, path: "M3 4h8v4H3zM13 4h8v4h-8zM3 10h8v4H3zM13 10h8v4h-8zM3 16h8v4H3zM13 16h8v4h-8z"};
  return {
    responsive: true, displaylogo: false,
    showSendToCloud: false, plotlyServerURL: "",  // no data leaves the report
    toImageButtonOptions: {format: "svg", filename: chart.name},
    modeBarButtonsToAdd: [{name: "Numbers as CSV", icon: icon,
                           click: () => saveText(chart.name + ".csv", makeCsv(chart))}]};
}

function explain(div, text) {
  const note = document.createElement("p");
  note.className = "problem";
  note.textContent = text;
  div.style.height = "auto";
  div.append(note);
}

// The chart's traces and layout for the width of its place. Pages of earlier versions have one form.
function makeFigure(chart, narrow) {
  const form = narrow ? chart.narrow : chart;
  const data = !narrow ? chart.data : chart.data.map((trace, i) => chart.narrow.colorbars[i] === null ? trace
      : {...trace, marker: {...trace.marker, colorbar: chart.narrow.colorbars[i]}});
  // On a touch screen, scrolling the page must not zoom a chart.
  const isTouched = window.matchMedia("(pointer: coarse)").matches;
  const margin = {...form.layout.margin, t: buttonHeight};
  return {data: paint(data, readColor("--ink")), height: form.height + buttonHeight,
          layout: {...paint(form.layout, readColor("--ink")), margin, ...(isTouched && {dragmode: false}), template: makeTemplate(),
                   uirevision: narrow ? "narrow" : "wide"}};  // while this stays, what the reader zoomed and hid stays
}

const isNarrow = (div, chart) => chart.narrow !== undefined && div.parentElement.clientWidth < minWidthRatio * chart.width;

async function drawChart(div) {
  const chart = JSON.parse(div.querySelector("script").textContent);
  const shown = {div, chart, isNarrow: isNarrow(div, chart)};
  const figure = makeFigure(chart, shown.isNarrow);
  div.style.height = figure.height + "px";
  if (!shown.isNarrow) div.style.minWidth = minWidthRatio * chart.width + "px";
  await Plotly.newPlot(div, figure.data, figure.layout, makeConfig(chart));
  strutCharts.push(shown);
}

// Redraws a chart for its place or for paper; the line at an instant stays.
function redraw(shown) {
  const {div, chart} = shown;
  shown.isNarrow = !isForPaper && isNarrow(div, chart);
  const figure = makeFigure(chart, shown.isNarrow);
  div.style.height = figure.height + "px";
  div.style.minWidth = shown.isNarrow ? "" : minWidthRatio * chart.width + "px";
  const size = isForPaper ? {autosize: false, width: paperWidth, height: figure.height} : {autosize: true};
  Plotly.react(div, figure.data, {...figure.layout, shapes: div.layout.shapes, ...size}, makeConfig(chart));
}

// Redraws the charts whose place has become too narrow for them, or wide enough again.
function fitAll() {
  for (const shown of strutCharts) {
    if (!isForPaper && isNarrow(shown.div, shown.chart) !== shown.isNarrow) redraw(shown);
  }
}

// Redraws all charts in the colors of the screen, light or dark, or of paper.
function repaintAll(forPaper) {
  isForPaper = forPaper;
  for (const shown of strutCharts) redraw(shown);
}

// plotly.js is packed in the page, to a third of its length.
async function loadPlotly() {
  const packed = Uint8Array.from(atob(document.getElementById("plotly").textContent), (c) => c.charCodeAt(0));
  const code = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(code).text();
  document.head.append(script);
}

async function drawAll() {
  const divs = [...document.querySelectorAll("div.chart")];
  let drawn = 0;
  try {
    if (divs.length > 0) await loadPlotly();
  } catch (error) {
    console.error(error);
    for (const div of divs) {
      explain(div, "This browser cannot unpack the charts: it must be Chrome 80, Firefox 113, Safari 16.4 or later. Their numbers are in the files named below.");
    }
    document.body.dataset.charts = "0/" + divs.length;
    return;
  }
  for (const div of divs) {
    try {
      await drawChart(div);
      ++drawn;
      await new Promise((resolve) => setTimeout(resolve));  // shows it before the next is drawn
    } catch (error) {
      console.error(error);
      explain(div, "This chart could not be drawn: " + error.message);
    }
  }
  document.body.dataset.charts = drawn + "/" + divs.length;
}

darkMode.addEventListener("change", () => repaintAll(false));
window.addEventListener("resize", fitAll);
let opened = [];  // for a print
window.addEventListener("beforeprint", () => {
  opened = [...document.querySelectorAll("details.fold:not([open])")];
  opened.forEach((fold) => { fold.open = true; });
  repaintAll(true);
});
window.addEventListener("afterprint", () => {
  opened.forEach((fold) => { fold.open = false; });
  repaintAll(false);
});
