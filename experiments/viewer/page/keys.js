'use strict';

/* The keys of the page, in one table: what they do, and their list on the page. */

const kTurn = Math.PI / 24;  // of the camera
const kCloser = 0.85;

/* key: as KeyboardEvent has it; shift: whether it is held; name, text: in the list. */
function shortcutsOf(player) {
  const step = (seconds) => () => player.setTime(player.time + seconds);
  const turn = (about, over) => () => player.turn(about * kTurn, over * kTurn);
  const {timeline} = player.views[0];
  const plain = [
    [' ', 'space', 'play, pause', () => player.setPlaying(!player.playing)],
    ['ArrowLeft', '←', '0.1 s back', step(-0.1)],
    ['ArrowRight', '→', '0.1 s forward', step(0.1)],
    ['Home', 'home', 'to the start', () => player.setTime(player.begin)],
    ['End', 'end', 'to the end', () => player.setTime(player.end)],
    ['PageUp', 'page up', 'previous action', () => player.toLeg(-1)],
    ['PageDown', 'page down', 'next action', () => player.toLeg(1)],
    ['+', '+', 'zoom into the timeline', () => timeline.zoomBy(0.5)],
    ['-', '−', 'zoom out of the timeline', () => timeline.zoomBy(2)],
    ['0', '0', 'the whole plan', () => timeline.showAll()],
    ['s', 's', 'this segment alone', () => player.zoomToSegment()],
    ['p', 'p', 'plots', () => player.openPlots(element('plots').hidden)],
    ['1', '1', 'view from a corner', () => player.look('iso')],
    ['2', '2', 'view from above', () => player.look('top')],
    ['3', '3', 'view from the side', () => player.look('side')],
  ].map(([key, name, text, act]) => ({key, name, text, act}));
  const withShift = [
    ['ArrowLeft', 'shift ←', 'turn the view left', turn(-1, 0)],
    ['ArrowRight', 'shift →', 'turn the view right', turn(1, 0)],
    ['ArrowUp', 'shift ↑', 'turn the view up', turn(0, 1)],
    ['ArrowDown', 'shift ↓', 'turn the view down', turn(0, -1)],
    ['PageUp', 'shift page up', 'nearer', () => player.approach(kCloser)],
    ['PageDown', 'shift page down', 'farther', () => player.approach(1 / kCloser)],
  ].map(([key, name, text, act]) => ({key, name, text, act, shift: true}));
  return plain.concat(withShift);
}

function listShortcuts(shortcuts, list) {
  for (const {name, text} of shortcuts) {
    addText(list, 'dt', name);
    addText(list, 'dd', text);
  }
}

/* Whether the element that has the focus needs the key itself. */
function isTaken(key, target) {
  if (target.tagName === 'SELECT') return true;
  return key === ' ' && ['BUTTON', 'INPUT', 'SUMMARY', 'A'].includes(target.tagName);
}

function connectKeys(player) {
  const shortcuts = shortcutsOf(player);
  listShortcuts(shortcuts, element('keys'));
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || isTaken(event.key, event.target)) return;
    const moves = event.key.length > 1;  // '+' may need shift
    const found = shortcuts.find(
        ({key, shift}) => key === event.key && (!moves || Boolean(shift) === event.shiftKey));
    if (!found) return;
    found.act();
    player.announce();
    event.preventDefault();
  });
}
