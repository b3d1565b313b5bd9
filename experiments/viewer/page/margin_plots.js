'use strict';

/* The verifier's margins as curves. Each of the page's knots has the worst of the plan's knots since
   the one before it. */

const kMostShown = 0.25;  // m: there is no danger above
const kFarthest = 0.1;  // m: greater distances between bodies are not measured
const kMargins = {
  distances: [
    {column: 0, label: 'z.m.p. in support', colour: '#0b7285'},
    {column: 1, label: 'points on ground', colour: '#e6a117'},
    {column: 2, label: 'own links', colour: '#6a4c93', atMost: kFarthest},
    {column: 3, label: 'obstacles', colour: '#d1495b', atMost: kFarthest},
  ],
  shares: [
    {column: 4, label: 'torque', colour: '#2667c9'},
    {column: 5, label: 'friction', colour: '#d1495b'},
    {column: 6, label: 'joint speed', colour: '#1b998b'},
  ],
};

function distanceText(margin) {
  return (n) => n >= margin.atMost - 1e-6 ? 'over ' + margin.atMost : fixed(n, 3);
}

/* What the two plots of margins show; value(column) gives a curve's value. */
function marginContents(value) {
  const curves = (margins, scale, text) => margins.map((margin) => ({
    label: margin.label,
    colour: margin.colour,
    value: value(margin.column, scale),
    text: text(margin),
  }));
  return {
    shares: {
      curves: curves(kMargins.shares, 100, () => (n) => fixed(n, 0)),
      limits: [{y: 100, text: ''}],
      include: [0, 104],
    },
    distances: {
      curves: curves(kMargins.distances, 1, distanceText),
      limits: [{y: 0, text: ''}],
      most: kMostShown,
    },
  };
}
