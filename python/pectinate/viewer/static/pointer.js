// Mouse, pen, fingers and arrow keys: one pointer turns, two pinch and move; wheel zooms, shift or right button moves.

const KEY_STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const KEY_PIXELS = 20;

function followPointers(canvas, view, changed) {
  const pointers = new Map();
  const fromMiddle = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left - 0.5 * box.width, 0.5 * box.height - (event.clientY - box.top)];
  };
  const ballRadius = () => 0.33 * Math.min(canvas.clientWidth, canvas.clientHeight);

  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.classList.add('dragging');
    pointers.set(event.pointerId, fromMiddle(event));
  });
  canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = fromMiddle(event), dx = now[0] - before[0], dy = now[1] - before[1];
    if (pointers.size === 2) {
      const [fixed] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      const apart = (place) => Math.max(Math.hypot(place[0] - fixed[0], place[1] - fixed[1]), 1);
      view.zoom(apart(now) / apart(before), ...fixed);
      view.move(0.5 * dx, 0.5 * dy);
    } else if (event.shiftKey || event.buttons > 1) {
      view.move(dx, dy);
    } else {
      view.turn(dx, dy, ballRadius());
    }
    pointers.set(event.pointerId, now);
    changed();
  });
  for (const end of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(end, (event) => {
      pointers.delete(event.pointerId);
      if (pointers.size === 0) canvas.classList.remove('dragging');
    });
  }
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 0 ? 1 : 30);
    view.zoom(Math.exp(-0.0015 * pixels), ...fromMiddle(event));
    changed();
  }, { passive: false });
  canvas.addEventListener('keydown', (event) => {
    const step = KEY_STEPS[event.key];
    if (!step) return;
    event.preventDefault();
    if (event.shiftKey) view.move(KEY_PIXELS * step[0], KEY_PIXELS * step[1]);
    else view.turn(KEY_PIXELS * step[0], KEY_PIXELS * step[1], ballRadius());
    changed();
  });
}
