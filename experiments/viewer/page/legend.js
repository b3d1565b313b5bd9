'use strict';

/* What colours mean. Two plans share the entries that they have in common. */

function addKey(text, colour, kind) {
  const known = [...element('legend').children].find(
      (key) => key.textContent === text && key.style.getPropertyValue('--colour') === colour);
  if (known) return known;
  const key = addText(element('legend'), 'span', text);
  key.className = 'key ' + kind;
  key.style.setProperty('--colour', colour);
  return key;
}

function addKeysOfMotion({data, motion}) {
  if (!motion.phases.length) return;
  data.contacts.forEach((contact, i) => addKey(contact.name, limbColour(i), 'limb'));
  addKey('centre of mass', kCentreColour, 'line');
  if (motion.flights().length) {
    addKey('its flight', kArcColour, 'line');
    const known = ['preparation', 'crouch', 'toes', 'flight', 'settle', 'landing'];
    const names = new Set(motion.phases.map((phase) => phase.name));
    for (const name of known.filter((word) => names.has(word))) {
      addKey(name, kPhaseColours[name], 'phase');
    }
  }
  if (motion.phases.some((phase) => phase.impulses.length)) {
    addKey('impact', kImpulseColour, 'line');
  }
}

/* Returns those that are shown only while their switch is on. */
function addBalanceKeys() {
  const keys = [
    addKey('support polygon', kSupportColour, 'action'),
    addKey('zero moment point', kZmpColour, 'limb'),
    addKey('capture point', kCaptureColour, 'ring'),
    addKey('share of the weight', '#667180', 'bar'),
  ];
  keys.forEach((key) => { key.hidden = true; });
  return keys;
}

function addKeysOfNo({no}) {
  if (!no) return;
  if (no.passage) addKey('narrowest place', kPassageColour, 'action');
  if (!no.barrier) return;
  const actions = new Set(no.barrier.reached.map((region) => region.action));
  for (const action of actions) {
    addKey('reached: ' + (action || 'the pelvis alone'), actionColour(action), 'action');
  }
  addKey('closes the way', kBarrierColour, 'action');
}

function addLegend(views) {
  for (const {data} of views) {
    const actions = new Set(data.segments.map((s) => s.action).concat(data.explored.actions));
    for (const action of actions) addKey(action, actionColour(action), 'action');
  }
  views.forEach(addKeysOfMotion);
  const balanceKeys = views.some((view) => view.moves) ? addBalanceKeys() : [];
  for (const {data} of views) addKeysOfNo(data);
  return {balanceKeys};
}
