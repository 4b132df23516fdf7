// A small 3-D view on a 2-D canvas: layers of points, triangles and lines, sorted by depth.
'use strict';
(() => {
  const scene = JSON.parse(document.getElementById('scene').textContent);
  const canvas = document.getElementById('view');
  const pen = canvas.getContext('2d');
  const heights = scene.kept.filter((_, i) => i % 3 === 2).sort((a, b) => a - b);
  const quantile = (sorted, share) => sorted[Math.floor((sorted.length - 1) * share)] ?? 0;
  const [low, high] = [quantile(heights, 0.01), quantile(heights, 0.99)];

  // The middle and the size of what matters: outliers must not shrink the rest.
  const axis = (k) => scene.kept.filter((_, i) => i % 3 === k).sort((a, b) => a - b);
  const spans = [0, 1, 2].map((k) => { const v = axis(k); return [quantile(v, 0.01), quantile(v, 0.99)]; });
  const middle = spans.map(([a, b]) => (a + b) / 2);
  const size = Math.hypot(...spans.map(([a, b]) => b - a)) || 1;

  const layers = [
    { key: 'free', name: 'proven-free space', color: '#5fb7c4', on: false, has: scene.free.length, draw: voxels },
    { key: 'obstacles', name: 'obstacles', color: '#a98be0', on: true, has: scene.triangles.length, draw: triangles },
    { key: 'removed', name: 'removed points', color: '#ff7043', on: false, has: scene.removed.length, draw: () => dots(scene.removed, '#ff7043') },
    { key: 'kept', name: 'points', color: '#6fa8dc', on: true, has: scene.kept.length, draw: () => dots(scene.kept, null) },
    { key: 'raw', name: 'paths as planned', color: '#ffb05c', on: false, has: scene.raw.length, draw: () => scene.raw.forEach((p) => line(p, '#ffb05c', 1.4, [5, 4])) },
    { key: 'paths', name: 'paths as refined', color: '#4da3ff', on: true, has: scene.paths.length, draw: () => scene.paths.forEach((p) => line(p, '#4da3ff', 2.4, [])) },
    { key: 'flown', name: 'path flown', color: '#f4f6f8', on: true, has: scene.flown.length, draw: () => line(scene.flown, '#f4f6f8', 1.8, []) },
    { key: 'exits', name: 'exits', color: '#ffd43b', on: true, has: scene.exits.length, draw: exits },
  ];

  const start = { yaw: -0.9, pitch: 0.85, distance: 1.15 * size, target: [...middle], cut: 1 };
  let view = structuredClone(start);
  let frame = null;

  // Camera coordinates of a point: right, down, depth.
  function eye(x, y, z) {
    const [dx, dy, dz] = [x - view.target[0], y - view.target[1], z - view.target[2]];
    const [cy, sy, cp, sp] = [Math.cos(view.yaw), Math.sin(view.yaw), Math.cos(view.pitch), Math.sin(view.pitch)];
    const right = cy * dx + sy * dy;
    const ahead = -sy * dx + cy * dy;
    return [right, -(cp * dz + sp * ahead), view.distance + cp * ahead - sp * dz];
  }

  function project(x, y, z) {
    const [right, down, depth] = eye(x, y, z);
    const near = 0.02 * size;
    const scale = frame.focal / Math.max(depth, near);
    return [frame.width / 2 + right * scale, frame.height / 2 + down * scale, depth, depth > near];
  }

  const ceiling = () => low + (high - low) * view.cut + (view.cut >= 1 ? Infinity : 0);

  // Far to near by buckets, so that thousands of points sort in no time.
  function byDepth(items) {
    const buckets = Array.from({ length: 256 }, () => []);
    const reach = view.distance + size;
    for (const item of items) {
      const place = Math.floor(255 * Math.min(1, Math.max(0, item.depth / reach)));
      buckets[255 - place].push(item);
    }
    return buckets.flat();
  }

  // From blue below over green to yellow above.
  function tint(z) {
    const t = Math.min(1, Math.max(0, (z - low) / (high - low || 1)));
    return `hsl(${215 - 165 * t} 70% ${58 + 8 * t}%)`;
  }

  function dots(points, color) {
    const items = [];
    const top = ceiling();
    for (let i = 0; i < points.length; i += 3) {
      if (points[i + 2] > top) continue;
      const [x, y, depth, visible] = project(points[i], points[i + 1], points[i + 2]);
      if (visible && x > -9 && y > -9 && x < frame.width + 9 && y < frame.height + 9) {
        items.push({ x, y, depth, color: color ?? tint(points[i + 2]) });
      }
    }
    for (const { x, y, depth, color: fill } of byDepth(items)) {
      const side = Math.min(4, Math.max(1.1, 1.9 * view.distance / depth));
      pen.fillStyle = fill;
      pen.fillRect(x - side / 2, y - side / 2, side, side);
    }
  }

  function voxels() {
    pen.globalAlpha = 0.16;
    const side = scene.voxel * Math.cbrt(scene.voxelStep);
    const top = ceiling();
    pen.fillStyle = '#5fb7c4';
    for (let i = 0; i < scene.free.length; i += 3) {
      if (scene.free[i + 2] > top) continue;
      const [x, y, depth, visible] = project(scene.free[i], scene.free[i + 1], scene.free[i + 2]);
      const edge = side * frame.focal / depth;
      if (visible) pen.fillRect(x - edge / 2, y - edge / 2, edge, edge);
    }
    pen.globalAlpha = 1;
  }

  function triangles() {
    const { vertices, triangles: corners } = scene;
    const items = [];
    const top = ceiling();
    for (let i = 0; i < corners.length; i += 3) {
      const at = [0, 1, 2].map((k) => 3 * corners[i + k]);
      if (at.some((j) => vertices[j + 2] > top)) continue;
      const p = at.map((j) => project(vertices[j], vertices[j + 1], vertices[j + 2]));
      if (p.every((q) => q[3])) items.push({ p, depth: (p[0][2] + p[1][2] + p[2][2]) / 3 });
    }
    pen.fillStyle = 'rgba(150, 120, 215, 0.20)';
    pen.strokeStyle = 'rgba(180, 155, 235, 0.28)';
    pen.lineWidth = 0.6;
    for (const { p } of byDepth(items)) {
      pen.beginPath();
      p.forEach((q, k) => (k ? pen.lineTo(q[0], q[1]) : pen.moveTo(q[0], q[1])));
      pen.closePath();
      pen.fill();
      pen.stroke();
    }
  }

  function line(points, color, width, dash) {
    pen.strokeStyle = color;
    pen.lineWidth = width;
    pen.lineJoin = 'round';
    pen.setLineDash(dash);
    pen.beginPath();
    let drawing = false;
    for (let i = 0; i < points.length; i += 3) {
      const [x, y, , visible] = project(points[i], points[i + 1], points[i + 2]);
      if (visible && drawing) pen.lineTo(x, y);
      else if (visible) pen.moveTo(x, y);
      drawing = visible;
    }
    pen.stroke();
    pen.setLineDash([]);
  }

  function exits() {
    for (const [color, width] of [['#4a3800', 5], ['#ffd43b', 2.6]]) {
      pen.strokeStyle = color;
      pen.lineWidth = width;
      pen.lineCap = 'round';
      for (let i = 0; i < scene.exits.length; i += 3) {
        const [x, y, , visible] = project(scene.exits[i], scene.exits[i + 1], scene.exits[i + 2]);
        if (!visible) continue;
        pen.beginPath();
        pen.moveTo(x - 7, y - 7); pen.lineTo(x + 7, y + 7);
        pen.moveTo(x - 7, y + 7); pen.lineTo(x + 7, y - 7);
        pen.stroke();
      }
    }
  }

  // A bar of a round length at the target's depth.
  function scaleBar() {
    const perUnit = frame.focal / view.distance;
    const wanted = 120 / perUnit;
    const power = 10 ** Math.floor(Math.log10(wanted));
    const length = [1, 2, 5, 10].map((k) => k * power).filter((x) => x <= wanted * 1.2).pop() ?? power;
    const [x, y] = [18, frame.height - 18];
    pen.strokeStyle = pen.fillStyle = '#c8d0da';
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(x, y - 5); pen.lineTo(x, y); pen.lineTo(x + length * perUnit, y); pen.lineTo(x + length * perUnit, y - 5);
    pen.stroke();
    pen.font = '13px system-ui, sans-serif';
    pen.fillText(`${+length.toPrecision(3)} ${scene.unit}`, x + 6, y - 8);
  }

  let waiting = false;
  function redraw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; draw(); });
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    frame = { width, height, focal: 1.1 * Math.min(width, height) };
    pen.clearRect(0, 0, width, height);
    for (const layer of layers) if (layer.on && layer.has) layer.draw();
    scaleBar();
  }

  const switches = document.getElementById('switches');
  for (const layer of layers.filter((candidate) => candidate.has).reverse()) {
    const label = document.createElement('label');
    const box = Object.assign(document.createElement('input'), { type: 'checkbox', checked: layer.on });
    box.addEventListener('change', () => { layer.on = box.checked; redraw(); });
    const chip = document.createElement('i');
    chip.style.background = layer.color;
    label.append(box, chip, layer.name);
    switches.append(label);
  }
  const cutLabel = document.createElement('label');
  const cut = Object.assign(document.createElement('input'), { type: 'range', min: 0, max: 1, step: 0.01, value: 1 });
  cut.addEventListener('input', () => { view.cut = +cut.value; redraw(); });
  cutLabel.append('cut off above', cut);
  switches.append(cutLabel);

  function rotate(dx, dy) {
    view.yaw -= dx;
    view.pitch = Math.min(Math.PI / 2, Math.max(-0.3, view.pitch + dy));
    redraw();
  }
  function zoom(factor) {
    view.distance = Math.min(6 * size, Math.max(0.05 * size, view.distance * factor));
    redraw();
  }
  function move(dx, dy) {
    const unit = view.distance / frame.focal;
    const [c, s] = [Math.cos(view.yaw), Math.sin(view.yaw)];
    view.target[0] -= unit * (c * dx + s * dy);
    view.target[1] -= unit * (s * dx - c * dy);
    redraw();
  }

  const fingers = new Map();
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener('pointermove', (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const spread = () => { const [a, b] = [...fingers.values()]; return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
    const before = spread();
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
    if (fingers.size > 1 && before > 0) zoom(before / Math.max(1, spread()));
    else if (event.shiftKey || event.buttons === 4) move(dx, dy);
    else rotate(0.008 * dx, 0.008 * dy);
  });
  for (const end of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener('wheel', (event) => { event.preventDefault(); zoom(Math.exp(0.0012 * event.deltaY)); }, { passive: false });
  canvas.addEventListener('dblclick', () => { view = { ...structuredClone(start), cut: +cut.value }; redraw(); });
  canvas.addEventListener('keydown', (event) => {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    if (turns[event.key]) rotate(...turns[event.key]);
    else if (event.key === '+' || event.key === '=') zoom(0.85);
    else if (event.key === '-') zoom(1.18);
    else return;
    event.preventDefault();
  });
  window.addEventListener('resize', redraw);
  draw();
})();
