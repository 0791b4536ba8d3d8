// MIDI: while the button MIDI is pressed, a touched control isn't changed but learned: the next MIDI control sets it.
'use strict';

(() => {
  const button = document.getElementById('midi');
  const output = document.getElementById('midi-state');
  let learns = false;
  let awaited = '';  // address of the control that is being learned

  function show() {
    button.setAttribute('aria-pressed', String(learns));
    document.body.classList.toggle('learns', learns);
    output.hidden = !learns;
    output.textContent = awaited ? 'Move the MIDI control for ' + awaited : 'Touch a value or a button, then move a MIDI control';
  }
  function setLearns(on) {
    learns = on;
    if (!on && awaited) link.send('/midi/learn', '', []);
    show();
  }

  // The number of a vector that was touched, from 1; 0: the value is one number.
  function component(row, target) {
    const axes = [...row.querySelectorAll('.axis')];
    return axes.length > 1 ? Math.max(axes.indexOf(target.closest('.axis')), 0) + 1 : 0;
  }
  function learn(row, target) {
    const number = component(row, target);
    link.send('/midi/learn', number ? 'si' : 's', number ? [row.dataset.address, number] : [row.dataset.address]);
  }
  function intercept(event) {
    const row = learns && event.target.closest ? event.target.closest('.row[data-address]') : null;
    if (!row) return;
    event.preventDefault();
    event.stopPropagation();
    if (event.type === 'click') learn(row, event.target);
  }
  for (const name of ['pointerdown', 'mousedown', 'touchstart', 'click']) document.addEventListener(name, intercept, { capture: true, passive: false });

  button.addEventListener('click', () => setLearns(!learns));
  document.addEventListener('keydown', (event) => { if (event.key === 'Escape' && learns) setLearns(false); });
  link.listen('/midi/learning', ([address]) => {
    awaited = address || '';
    show();
  });
})();
