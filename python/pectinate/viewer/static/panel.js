// Buttons, switches and the slider.

const FOLD_BELOW = 640;  // CSS pixels
const SHOWN_NOTES = 3;

class Panel {
  constructor(root, title) {
    this.root = root;
    root.hidden = false;
    const fold = this.button(root, '\u2630', () => root.classList.toggle('folded'));
    fold.className = 'fold';
    fold.setAttribute('aria-label', 'Show or hide the controls');
    root.classList.toggle('folded', window.innerWidth < FOLD_BELOW);
    element(root, 'h1', title);
  }

  heading(text) {
    element(this.root, 'h2', text);
  }

  // Few lines are shown, many wait until they are asked for.
  notes(lines) {
    const details = element(this.root, 'details');
    details.open = lines.length <= SHOWN_NOTES;
    element(details, 'summary', 'Notes');
    for (const line of lines) element(details, 'p', line);
  }

  button(parent, text, clicked) {
    const button = element(parent, 'button', text);
    button.type = 'button';
    button.addEventListener('click', clicked);
    return button;
  }

  buttons(names, clicked) {
    const grid = element(this.root, 'div');
    grid.className = 'views';
    names.forEach((name, index) => this.button(grid, name, () => clicked(index)));
  }

  save(text, clicked) {
    this.button(this.root, text, clicked).className = 'save';
  }

  toggle(name, text, checked, changed) {
    const label = element(this.root, 'label');
    const box = element(label, 'input');
    Object.assign(box, { type: 'checkbox', name, checked });
    label.append(text);
    box.addEventListener('change', () => changed(box.checked));
  }

  choice(name, texts, chosen, changed) {
    const select = element(this.root, 'select');
    Object.assign(select, { name });
    select.setAttribute('aria-label', name);
    for (const text of texts) element(select, 'option', text);
    select.selectedIndex = chosen;
    select.addEventListener('change', () => changed(select.selectedIndex));
  }

  slider(name, text, [low, high], value, changed) {
    const label = element(this.root, 'label', text);
    const number = element(label, 'output', `${value.toPrecision(2)} mm`);
    const slider = element(this.root, 'input');
    Object.assign(slider, { type: 'range', name, min: low, max: high, step: (high - low) / 200, value });
    slider.setAttribute('aria-label', text);
    slider.addEventListener('input', () => {
      number.textContent = `${Number(slider.value).toPrecision(2)} mm`;
      changed(Number(slider.value));
    });
  }
}

function element(parent, kind, text = '') {
  const child = document.createElement(kind);
  child.textContent = text;
  parent.append(child);
  return child;
}
