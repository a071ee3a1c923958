// Draws the charts of a report: each div.chart has a script element with the JSON of make_plotly().
// Once all charts are drawn or have failed, the body's data-charts is "DRAWN/TOTAL".
"use strict";

const strutCharts = [];
const darkMode = window.matchMedia("(prefers-color-scheme: dark)");

// Colors on paper, which is white even if the screen is dark. During "beforeprint" the computed
// styles are still those of the screen.
const paperColors = {"--ink": "#1b1f24", "--line": "#d0d7de", "--soft": "#57606a", "--paper": "#ffffff"};
const paperWidth = 980;  // px
const buttonHeight = 30;  // px above the legend
const minWidthRatio = 0.8;  // to a chart's nominal width; a narrower page scrolls
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
                autotickangles: [0, -30, -90], automargin: false, title: {standoff: 8, font: {size: 12}}};
  return {layout: {
    font: {color: ink, size: 13, family: "system-ui, 'DejaVu Sans', Arial, sans-serif"},
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", xaxis: axis, yaxis: axis,
    modebar: {bgcolor: readColor("--paper"), color: readColor("--soft"), activecolor: ink},
    legend: {itemsizing: "constant"},  // small points would be invisible
    hoverlabel: {namelength: -1}}};
}

// Copies a trace with the color "ink" replaced by that of the page.
function paint(value, ink) {
  if (value === "ink") return ink;
  if (Array.isArray(value)) {
    return value.some((item) => typeof item === "object" && item) ? value.map((v) => paint(v, ink)) : value;
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

async function drawChart(div) {
  const chart = JSON.parse(div.querySelector("script").textContent);
  div.style.height = chart.height + buttonHeight + "px";
  div.style.minWidth = minWidthRatio * chart.width + "px";
  const margin = {...chart.layout.margin, t: buttonHeight};
  // On a touch screen, scrolling the page must not zoom a chart.
  const isTouched = window.matchMedia("(pointer: coarse)").matches;
  const layout = {...chart.layout, margin, ...(isTouched && {dragmode: false}), template: makeTemplate()};
  await Plotly.newPlot(div, paint(chart.data, readColor("--ink")), layout, makeConfig(chart));
  strutCharts.push({div, chart});
}

// Redraws all charts in the colors of the screen, light or dark, or of paper.
function repaintAll(forPaper) {
  isForPaper = forPaper;
  for (const {div, chart} of strutCharts) {
    const size = forPaper ? {autosize: false, width: paperWidth, height: chart.height + buttonHeight} : {autosize: true};
    Plotly.react(div, paint(chart.data, readColor("--ink")),
                 {...div.layout, width: undefined, height: undefined, ...size, template: makeTemplate()},
                 makeConfig(chart));
  }
}

async function drawAll() {
  const divs = [...document.querySelectorAll("div.chart")];
  let drawn = 0;
  for (const div of divs) {
    try {
      await drawChart(div);
      ++drawn;
    } catch (error) {
      console.error(error);
      explain(div, "This chart could not be drawn: " + error.message);
    }
  }
  document.body.dataset.charts = drawn + "/" + divs.length;
}

darkMode.addEventListener("change", () => repaintAll(false));
window.addEventListener("beforeprint", () => repaintAll(true));
window.addEventListener("afterprint", () => repaintAll(false));
