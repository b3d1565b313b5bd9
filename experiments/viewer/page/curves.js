'use strict';

/* Drawing in two dimensions that timeline and plots share, and one plot of curves over time. */

/* Sizes a canvas to its element and returns its context, whose unit is a CSS pixel. */
function openCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext('2d');
  context.scale(ratio, ratio);
  context.clearRect(0, 0, width, height);
  return {context, width, height};
}

/* toFixed without a minus sign before nothing but zeros. */
const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0(\.0*)?)$/, '$1');

/* Round numbers within [low, high], about `count` of them. */
function ticks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].map((n) => n * power).find((n) => n >= rough * 0.999);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
    found.push({value: i * step, text: fixed(i * step, digits)});
  }
  return found;
}

/* Black or white, whichever is easier to read on a colour (WCAG 2, relative luminance). */
function inkOn(colour) {
  const {r, g, b} = new THREE.Color(colour);
  const linear = (part) => part <= 0.04045 ? part / 12.92 : Math.pow((part + 0.055) / 1.055, 2.4);
  const luminance = 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  return (luminance + 0.05) / 0.05 > 1.05 / (luminance + 0.05) ? '#000000' : '#ffffff';
}

/* A colour as it looks on white with less than full opacity. */
function onWhite(colour, opacity) {
  return '#' + new THREE.Color('#ffffff').lerp(new THREE.Color(colour), opacity).getHexString();
}

const kPlotMargin = {left: 38, right: 6, top: 4, bottom: 16};  // px
const kManyPhases = 40;  // whose curves would run into each other
const kLimitColour = '#c2182b';
const kPlotFont = '10.5px system-ui, "DejaVu Sans", sans-serif';

/* A figure: caption with the names and present values of its curves, panel, time cursor. */
class CurvePlot {
  /* source: where the curves come from. seek(t) is called with the time that is clicked. */
  constructor(parent, title, unit, source, seek) {
    this.figure = addText(parent, 'figure', '');
    this.figure.title = source;
    const caption = addText(this.figure, 'figcaption', '');
    addText(caption, 'b', title);
    addText(caption, 'i', unit);
    this.keys = addText(this.figure, 'div', '');
    this.keys.className = 'keys';
    this.panel = addText(this.figure, 'div', '');
    this.panel.className = 'panel';
    this.canvas = addText(this.panel, 'canvas', '');
    this.canvas.setAttribute('aria-hidden', 'true');  // the keys have its values
    this.cursor = addText(this.panel, 'div', '');
    this.cursor.className = 'cursor';
    const onPointer = (event) => {
      const box = this.panel.getBoundingClientRect();
      const inner = box.width - kPlotMargin.left - kPlotMargin.right;
      const fraction = (event.clientX - box.left - kPlotMargin.left) / inner;
      seek(this.begin + Math.min(1, Math.max(0, fraction)) * (this.end - this.begin));
    };
    this.panel.addEventListener('pointerdown', (event) => {
      this.panel.setPointerCapture(event.pointerId);
      onPointer(event);
    });
    this.panel.addEventListener('pointermove', (event) => {
      if (event.buttons) onPointer(event);
    });
  }

  /* content: {phases, curves, limits, marks, range, include (at least, if there is no range),
     most (that an axis without range shows), bandColour}. A curve is {label, colour, dashed,
     faint, value(phase, k), text(value), reading(phase, k)}; what is read out is the text of the
     reading, or of the value if there is none. limits are {y, text, colour}, marks
     {t, text, colour}. */
  show(content, begin, end) {
    Object.assign(this, content, {begin, end});
    this.keys.textContent = '';
    this.labels = this.curves.filter((curve) => curve.label).map((curve) => {
      const key = addText(this.keys, 'span', curve.label + ' ');
      key.className = 'curve' + (curve.dashed ? ' dashed' : '');
      key.style.setProperty('--colour', curve.colour);
      return {curve, value: addText(key, 'span', '')};
    });
    this.draw();
  }

  x(t) {
    return kPlotMargin.left + (t - this.begin) / (this.end - this.begin) * this.inner.width;
  }
  y(value) {
    const [low, high] = this.axis;
    return kPlotMargin.top + (high - value) / (high - low) * this.inner.height;
  }

  draw() {
    const {context, width, height} = openCanvas(this.canvas);
    this.inner = {width: width - kPlotMargin.left - kPlotMargin.right,
                  height: height - kPlotMargin.top - kPlotMargin.bottom};
    if (this.inner.width < 10 || this.inner.height < 10) return;
    this.lines = this.curves.map((curve) => this.trace(curve));
    this.axis = this.range || this.findRange();
    context.font = kPlotFont;
    this.drawBands(context);
    this.drawAxes(context);
    context.save();
    context.beginPath();
    context.rect(kPlotMargin.left, kPlotMargin.top, this.inner.width, this.inner.height);
    context.clip();
    // Dashed ones on top of solid ones that they may coincide with, and the first of each last.
    const layer = (curve) => curve.faint ? 0 : curve.dashed ? 2 : 1;
    const order = this.curves.map((_, i) => i).reverse();
    order.sort((i, j) => layer(this.curves[i]) - layer(this.curves[j]));
    for (const i of order) this.drawCurve(context, this.curves[i], this.lines[i]);
    context.restore();
    this.marks.forEach((mark) => this.drawMark(context, mark));
  }

  /* A curve's points, one list per phase in which it has a value. */
  trace(curve) {
    const pieces = [];
    for (const phase of this.phases) {
      const piece = [];
      for (let k = 0; k < phase.count; ++k) {
        const value = curve.value(phase, k);
        if (value !== null) piece.push([this.time(phase, k), value]);
      }
      if (piece.length) pieces.push(this.thinned(piece));
    }
    return pieces;
  }

  /* Of more points than there are pixels, the lowest and the highest of each pixel. */
  thinned(piece) {
    const pixel = (this.end - this.begin) / this.inner.width;
    const [start, stop] = [piece[0][0], piece[piece.length - 1][0]];
    if (piece.length * pixel < 2 * (stop - start)) return piece;
    const kept = [piece[0]];
    let low = null, high = null, column = -1;
    const keep = () => {
      if (low) kept.push(...(low[0] < high[0] ? [low, high] : [high, low]));
    };
    for (const point of piece) {
      const next = Math.floor((point[0] - start) / pixel);
      if (next !== column) {
        keep();
        [low, high, column] = [point, point, next];
      }
      if (point[1] < low[1]) low = point;
      if (point[1] > high[1]) high = point;
    }
    keep();
    kept.push(piece[piece.length - 1]);
    return kept;
  }

  findRange() {
    let low = Infinity, high = -Infinity;
    const include = (value) => { low = Math.min(low, value); high = Math.max(high, value); };
    for (const pieces of this.lines) {
      for (const piece of pieces) {
        for (const [t, value] of piece) if (t >= this.begin && t <= this.end) include(value);
      }
    }
    this.limits.forEach((limit) => include(limit.y));
    this.include.forEach(include);
    high = Math.min(high, Math.max(low, this.most));
    if (!(low <= high)) return [0, 1];
    const pad = Math.max(0.06 * (high - low), 1e-3 * Math.max(1, Math.abs(high)));
    return [low - pad, high + pad];
  }

  drawBands(context) {
    for (const phase of this.phases) {
      const x0 = this.x(Math.max(phase.begin, this.begin));
      const x1 = this.x(Math.min(phase.end, this.end));
      if (x1 <= x0) continue;
      context.globalAlpha = 0.16;
      context.fillStyle = this.bandColour(phase);
      context.fillRect(x0, kPlotMargin.top, x1 - x0, this.inner.height);
      context.globalAlpha = 1;
    }
  }

  drawAxes(context) {
    const right = kPlotMargin.left + this.inner.width, bottom = kPlotMargin.top + this.inner.height;
    const line = (x0, y0, x1, y1, colour) => {
      context.strokeStyle = colour;
      context.beginPath();
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
      context.stroke();
    };
    context.lineWidth = 1;
    context.fillStyle = '#667180';
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    for (const tick of ticks(...this.axis, this.inner.height / 26)) {
      const y = Math.round(this.y(tick.value)) + 0.5;
      line(kPlotMargin.left, y, right, y, 'rgba(102, 113, 128, 0.18)');
      context.fillText(tick.text, kPlotMargin.left - 4, Math.max(6, y));
    }
    context.textAlign = 'center';
    context.textBaseline = 'top';
    const times = ticks(this.begin, this.end, this.inner.width / 42);
    times.forEach((tick, i) => {
      const x = Math.round(this.x(tick.value)) + 0.5;
      line(x, bottom, x, bottom + 3, '#98a2b0');
      const text = tick.text + (i + 1 === times.length ? ' s' : '');
      context.fillText(text, Math.min(x, right - context.measureText(text).width / 2), bottom + 4);
    });
    for (const limit of this.limits) {
      if (limit.y < this.axis[0] || limit.y > this.axis[1]) continue;
      const y = Math.round(this.y(limit.y)) + 0.5;
      context.setLineDash([4, 3]);
      line(kPlotMargin.left, y, right, y, limit.colour || kLimitColour);
      context.setLineDash([]);
      if (!limit.text) continue;
      context.fillStyle = limit.colour || kLimitColour;
      context.textAlign = 'right';
      context.textBaseline = y > kPlotMargin.top + 14 ? 'bottom' : 'top';
      context.fillText(limit.text, right - 3, y);
    }
    context.strokeStyle = '#b4bcc7';
    context.strokeRect(kPlotMargin.left + 0.5, kPlotMargin.top + 0.5, this.inner.width - 1,
                       this.inner.height);
  }

  drawCurve(context, curve, pieces) {
    context.strokeStyle = curve.colour;
    context.lineWidth = curve.faint || this.phases.length > kManyPhases ? 0.8 : 1.6;
    context.setLineDash(curve.dashed ? [5, 3] : []);
    for (const piece of pieces) {
      context.beginPath();
      piece.forEach(([t, value], i) => {
        if (i === 0) context.moveTo(this.x(t), this.y(value));
        else context.lineTo(this.x(t), this.y(value));
      });
      context.stroke();
    }
    context.setLineDash([]);
  }

  drawMark(context, mark) {
    if (mark.t < this.begin || mark.t > this.end) return;
    const x = this.x(mark.t);
    context.strokeStyle = context.fillStyle = mark.colour;
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x, kPlotMargin.top + this.inner.height);
    context.lineTo(x, kPlotMargin.top + 4);
    context.stroke();
    const onLeft = x > kPlotMargin.left + this.inner.width / 2;
    context.textAlign = onLeft ? 'right' : 'left';
    context.textBaseline = 'top';
    const place = [mark.text, x + (onLeft ? -5 : 5), kPlotMargin.top + 17];
    context.strokeStyle = '#ffffff';
    context.lineWidth = 3;
    context.strokeText(...place);
    context.fillStyle = '#1d2530';
    context.fillText(...place);
  }

  /* Moves the cursor to t, which lies in a phase at (k, fraction). */
  setTime(t, phase, {k, fraction}) {
    if (!this.inner) return;
    this.cursor.hidden = t < this.begin || t > this.end;
    this.cursor.style.left = this.x(t) + 'px';
    for (const {curve, value} of this.labels) {
      const read = curve.reading || curve.value;
      const before = read(phase, k), after = read(phase, k + 1);
      const text = before === null || after === null
          ? '–' : curve.text(before + fraction * (after - before));
      if (value.textContent !== text) value.textContent = text;
    }
  }
}
