// Draws the charts of a report. Each stands in a div.chart whose script element holds what
// make_plotly() wrote. When all are drawn, or have failed, the body's data-charts says
// "drawn/wanted".
"use strict";

const strutCharts = [];
const darkMode = window.matchMedia("(prefers-color-scheme: dark)");

// What is printed stands on white, also where the screen is dark; while "beforeprint" runs the
// styles are still those of the screen.
const paperColors = {"--ink": "#1b1f24", "--line": "#d0d7de", "--soft": "#57606a", "--paper": "#ffffff"};
const paperWidth = 980;  // px
const buttonHeight = 30;  // px above the legend
const leastShare = 0.8;  // of the width that a chart is made for; a narrower page is scrolled
let isForPaper = false;

function readColor(name) {
  if (isForPaper) return paperColors[name];
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

// Colors of the page for a chart's axes and texts.
function makeTemplate() {
  const ink = readColor("--ink");
  const line = readColor("--line");
  const axis = {gridcolor: line, zerolinecolor: line, linecolor: ink, showline: true, ticks: "outside",
                automargin: false, title: {standoff: 8, font: {size: 12}}};
  return {layout: {
    font: {color: ink, size: 13, family: "system-ui, 'DejaVu Sans', Arial, sans-serif"},
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", xaxis: axis, yaxis: axis,
    modebar: {bgcolor: readColor("--paper"), color: readColor("--soft"), activecolor: ink},
    hoverlabel: {namelength: -1}}};
}

// A copy of a trace in which the color "ink" is the page's.
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

// The numbers of a chart as drawn, a line a point; whiskers as what stands below and above y.
function makeCsv(chart) {
  const lines = ["panel,series,category,x,y,value,below,above"];
  for (const trace of chart.data) {
    const names = chart.layout[trace.xaxis.replace("x", "xaxis")].ticktext;
    const stands = trace.type !== "scatter" || trace.mode === "markers";  // at a place, or beside it
    const values = trace.marker?.showscale && trace.marker.color;
    const columns = [trace.x, trace.y, values, trace.error_y?.arrayminus, trace.error_y?.array];
    trace.x.forEach((x, i) => {
      const place = stands && names?.[Math.round(x) - 1];
      const words = [trace.meta, trace.name, place || ""].map(quoteCsv);
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
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);  // some browsers begin to save later
}

function makeConfig(chart) {
  const icon = {width: 24, height: 24, path: "M4 3h16v18H4zM4 9h16M4 15h16M12 3v18"};
  return {
    responsive: true, displaylogo: false,
    showSendToCloud: false, plotlyServerURL: "",  // a report's numbers stay where the report is
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
  div.style.minWidth = leastShare * chart.width + "px";
  const margin = {...chart.layout.margin, t: buttonHeight};
  // A finger that moves a page must not zoom a chart.
  const isTouched = window.matchMedia("(pointer: coarse)").matches;
  const layout = {...chart.layout, margin, ...(isTouched && {dragmode: false}), template: makeTemplate()};
  await Plotly.newPlot(div, paint(chart.data, readColor("--ink")), layout, makeConfig(chart));
  strutCharts.push({div, chart});
}

// Light, dark or paper: the same charts in other colors.
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
