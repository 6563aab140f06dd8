<?xml version="1.0" encoding="utf-8"?>
<!-- SPDX-License-Identifier: LGPL-2.1-or-later -->
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
  <context>
    <name>App::Property</name>
    <message>
      <source>95 % of the scan are nearer than this to the as-built part</source>
      <translation>95 % des Scans liegen näher als dies am Ist-Teil</translation>
    </message>
    <message>
      <source>95 % of the scan are nearer than this to the nominal part</source>
      <translation>95 % des Scans liegen näher als dies am Sollteil</translation>
    </message>
    <message>
      <source>Above 1 the displacement is smoother, below 1 it follows the scan more closely</source>
      <translation>Über 1 ist die Verschiebung glatter, unter 1 folgt sie dem Scan enger</translation>
    </message>
    <message>
      <source>Add the edges that go on from the named ones along tangency</source>
      <translation>Kanten hinzunehmen, die die genannten tangential fortsetzen</translation>
    </message>
    <message>
      <source>All stations, as CSV</source>
      <translation>Alle Stationen als CSV</translation>
    </message>
    <message>
      <source>Along the seam</source>
      <translation>Entlang der Naht</translation>
    </message>
    <message>
      <source>Control points after</source>
      <translation>Kontrollpunkte nachher</translation>
    </message>
    <message>
      <source>Control points before</source>
      <translation>Kontrollpunkte vorher</translation>
    </message>
    <message>
      <source>Control points in u and v, face by face</source>
      <translation>Kontrollpunkte in u und v, Fläche für Fläche</translation>
    </message>
    <message>
      <source>Control points of each face in u; 0: chosen from the data</source>
      <translation>Kontrollpunkte jeder Fläche in u; 0: aus den Daten gewählt</translation>
    </message>
    <message>
      <source>Control points of each face in v; 0: chosen from the data</source>
      <translation>Kontrollpunkte jeder Fläche in v; 0: aus den Daten gewählt</translation>
    </message>
    <message>
      <source>Distance to approach from and retract to</source>
      <translation>Abstand, aus dem angefahren und auf den zurückgezogen wird</translation>
    </message>
    <message>
      <source>Draw the control lattices</source>
      <translation>Kontrollgitter zeichnen</translation>
    </message>
    <message>
      <source>Faces that must not move</source>
      <translation>Flächen, die sich nicht bewegen dürfen</translation>
    </message>
    <message>
      <source>Find the joints of parts that touch within this distance; 0: the seams are the named edges</source>
      <translation>Stöße von Teilen finden, die sich bis auf diesen Abstand berühren; 0: die Nähte sind die genannten Kanten</translation>
    </message>
    <message>
      <source>Its number (KUKA), its name (ABB), or X,Y,Z,A,B,C in mm and degrees</source>
      <translation>Nummer (KUKA), Name (ABB) oder X,Y,Z,A,B,C in mm und Grad</translation>
    </message>
    <message>
      <source>Largest distance of stations</source>
      <translation>Größter Abstand der Stationen</translation>
    </message>
    <message>
      <source>Largest distance of the seam from the straight line between stations</source>
      <translation>Größter Abstand der Naht von der Geraden zwischen zwei Stationen</translation>
    </message>
    <message>
      <source>Layout of the properties</source>
      <translation>Aufbau der Eigenschaften</translation>
    </message>
    <message>
      <source>Lean of the torch about the travel direction</source>
      <translation>Neigung des Brenners um die Fahrtrichtung</translation>
    </message>
    <message>
      <source>Lean of the torch forwards, or back if negative</source>
      <translation>Neigung des Brenners nach vorn, negativ nach hinten</translation>
    </message>
    <message>
      <source>Mean distance of the scan from the as-built part</source>
      <translation>Mittlerer Abstand des Scans vom Ist-Teil</translation>
    </message>
    <message>
      <source>Mean distance of the scan from the nominal part</source>
      <translation>Mittlerer Abstand des Scans vom Sollteil</translation>
    </message>
    <message>
      <source>Scan points farther than this from the as-built part are outliers; 0: a default for most scans</source>
      <translation>Scanpunkte, die weiter als dies vom Ist-Teil entfernt sind, sind Ausreißer; 0: eine Vorgabe für die meisten Scans</translation>
    </message>
    <message>
      <source>Seam by seam: its edges, pass or fail</source>
      <translation>Naht für Naht: ihre Kanten, bestanden oder nicht</translation>
    </message>
    <message>
      <source>Show what the colours mean</source>
      <translation>Zeigen, was die Farben bedeuten</translation>
    </message>
    <message>
      <source>Source points on each face, for the methods ffds and ffd-hsu</source>
      <translation>Quellpunkte je Fläche, für die Verfahren ffds und ffd-hsu</translation>
    </message>
    <message>
      <source>Start nearest to the point Start</source>
      <translation>Am nächsten beim Punkt Start beginnen</translation>
    </message>
    <message>
      <source>The edges to weld, joined where they go on along tangency; with a tolerance, the joints on them</source>
      <translation>Die zu schweißenden Kanten, verbunden, wo sie sich tangential fortsetzen; mit Toleranz die Stöße an ihnen</translation>
    </message>
    <message>
      <source>The faces to deform, each by itself; none: the whole part</source>
      <translation>Die zu verformenden Flächen, jede für sich; keine: das ganze Teil</translation>
    </message>
    <message>
      <source>The nominal part</source>
      <translation>Das Sollteil</translation>
    </message>
    <message>
      <source>The part as it was designed, or none</source>
      <translation>Das Teil, wie es konstruiert wurde, oder keines</translation>
    </message>
    <message>
      <source>The part to weld</source>
      <translation>Das zu schweißende Teil</translation>
    </message>
    <message>
      <source>The point cloud that the part is deformed to</source>
      <translation>Die Punktwolke, an die das Teil angepasst wird</translation>
    </message>
    <message>
      <source>The report as JSON</source>
      <translation>Der Bericht als JSON</translation>
    </message>
    <message>
      <source>Weld in the other direction</source>
      <translation>In der anderen Richtung schweißen</translation>
    </message>
    <message>
      <source>What colours the seams</source>
      <translation>Was die Nähte einfärbt</translation>
    </message>
    <message>
      <source>What moves the parts when it moves</source>
      <translation>Was die Teile mitbewegt, wenn es sich bewegt</translation>
    </message>
    <message>
      <source>What the named faces looked like</source>
      <translation>Wie die genannten Flächen aussahen</translation>
    </message>
    <message>
      <source>What to know before welding</source>
      <translation>Was vor dem Schweißen zu wissen ist</translation>
    </message>
    <message>
      <source>Where a closed seam starts, or the end to start at, if StartHere is set</source>
      <translation>Wo eine geschlossene Naht beginnt, oder an welchem Ende, wenn StartHere gesetzt ist</translation>
    </message>
    <message>
      <source>Where the document's origin stands, given like the tool</source>
      <translation>Wo der Ursprung des Dokuments steht, angegeben wie das Werkzeug</translation>
    </message>
    <message>
      <source>Whether a whole sheet part is held inextensible</source>
      <translation>Ob ein ganzes Blechteil dehnungsfrei gehalten wird</translation>
    </message>
    <message>
      <source>robust copes with noise, gaps and clutter; ffds is the published algorithm</source>
      <translation>robust verträgt Rauschen, Lücken und Fremdes; ffds ist das veröffentlichte Verfahren</translation>
    </message>
  </context>
  <context>
    <name>FFDS</name>
    <message>
      <source>'{name}' is no face to freeze: write names like Face1, Face4.</source>
      <translation>„{name}“ ist keine Fläche, die man festhalten kann: Schreiben Sie Namen wie Face1, Face4.</translation>
    </message>
    <message>
      <source>ABB program (*.mod)</source>
      <translation>ABB-Programm (*.mod)</translation>
    </message>
    <message>
      <source>Add</source>
      <translation>Hinzufügen</translation>
    </message>
    <message>
      <source>Add robot trajectory</source>
      <translation>Roboterbahn hinzufügen</translation>
    </message>
    <message>
      <source>Align by three points</source>
      <translation>An drei Punkten ausrichten</translation>
    </message>
    <message>
      <source>Align scan</source>
      <translation>Scan ausrichten</translation>
    </message>
    <message>
      <source>Align scan by points</source>
      <translation>Scan an Punkten ausrichten</translation>
    </message>
    <message>
      <source>Aligning the scan</source>
      <translation>Der Scan wird ausgerichtet</translation>
    </message>
    <message>
      <source>All around</source>
      <translation>Von allen Seiten</translation>
    </message>
    <message>
      <source>All faces together, those that the scan does not see carried along</source>
      <translation>Alle Flächen gemeinsam; die der Scan nicht sieht, gehen mit</translation>
    </message>
    <message>
      <source>All points are picked: press OK.</source>
      <translation>Alle Punkte sind gewählt: Drücken Sie OK.</translation>
    </message>
    <message>
      <source>An as-built part beside it</source>
      <translation>Ein Ist-Teil daneben</translation>
    </message>
    <message>
      <source>Another task is open: finish or close it first.</source>
      <translation>Eine andere Aufgabe ist offen: Beenden oder schließen Sie sie zuerst.</translation>
    </message>
    <message>
      <source>As built</source>
      <translation>Ist</translation>
    </message>
    <message>
      <source>Automatic</source>
      <translation>Automatisch</translation>
    </message>
    <message>
      <source>Before or after the deformation</source>
      <translation>Vor oder nach der Verformung</translation>
    </message>
    <message>
      <source>Cancel</source>
      <translation>Abbrechen</translation>
    </message>
    <message>
      <source>Colours on</source>
      <translation>Farben auf</translation>
    </message>
    <message>
      <source>Computing the part</source>
      <translation>Das Teil wird berechnet</translation>
    </message>
    <message>
      <source>Computing the preview</source>
      <translation>Die Vorschau wird berechnet</translation>
    </message>
    <message>
      <source>Computing {part}</source>
      <translation>{part} wird berechnet</translation>
    </message>
    <message>
      <source>Control points</source>
      <translation>Kontrollpunkte</translation>
    </message>
    <message>
      <source>Control points in {direction}</source>
      <translation>Kontrollpunkte in {direction}</translation>
    </message>
    <message>
      <source>Coverage {share} %</source>
      <translation>Abdeckung {share} %</translation>
    </message>
    <message>
      <source>Decide from the scan</source>
      <translation>Aus dem Scan entscheiden</translation>
    </message>
    <message>
      <source>Deform</source>
      <translation>Verformen</translation>
    </message>
    <message>
      <source>Deform to scan</source>
      <translation>An Scan anpassen</translation>
    </message>
    <message>
      <source>Deviation</source>
      <translation>Abweichung</translation>
    </message>
    <message>
      <source>Deviation of the scan from the deformed faces</source>
      <translation>Abweichung des Scans von den verformten Flächen</translation>
    </message>
    <message>
      <source>Deviations up to this are shown in one green; 0: none</source>
      <translation>Abweichungen bis hierhin erscheinen in einem Grün; 0: keine</translation>
    </message>
    <message>
      <source>Export as-built part</source>
      <translation>Ist-Teil exportieren</translation>
    </message>
    <message>
      <source>Export robot program</source>
      <translation>Roboterprogramm exportieren</translation>
    </message>
    <message>
      <source>FFD by Hsu: a lattice in space</source>
      <translation>FFD nach Hsu: ein Gitter im Raum</translation>
    </message>
    <message>
      <source>FFDS as published</source>
      <translation>FFDS wie veröffentlicht</translation>
    </message>
    <message>
      <source>Faces of two parts are selected: choose those of one.</source>
      <translation>Flächen zweier Teile sind gewählt: Wählen Sie die eines Teils.</translation>
    </message>
    <message>
      <source>Faces that must not move, for instance Face1, Face4</source>
      <translation>Flächen, die sich nicht bewegen dürfen, zum Beispiel Face1, Face4</translation>
    </message>
    <message>
      <source>Find weld seams</source>
      <translation>Schweißnähte finden</translation>
    </message>
    <message>
      <source>Finding the seams</source>
      <translation>Die Nähte werden gesucht</translation>
    </message>
    <message>
      <source>Fine alignment from there</source>
      <translation>Von dort fein ausrichten</translation>
    </message>
    <message>
      <source>For the published methods, on each face</source>
      <translation>Für die veröffentlichten Verfahren, auf jeder Fläche</translation>
    </message>
    <message>
      <source>For whole sheet parts</source>
      <translation>Für ganze Blechteile</translation>
    </message>
    <message>
      <source>FreeCAD document with trajectories (*.FCStd)</source>
      <translation>FreeCAD-Dokument mit Bahnen (*.FCStd)</translation>
    </message>
    <message>
      <source>Freeze</source>
      <translation>Festhalten</translation>
    </message>
    <message>
      <source>Go on by closest points; without it the three pairs alone decide</source>
      <translation>Mit nächsten Punkten weitermachen; sonst entscheiden allein die drei Paare</translation>
    </message>
    <message>
      <source>How the control points are found</source>
      <translation>Wie die Kontrollpunkte gefunden werden</translation>
    </message>
    <message>
      <source>Import scan</source>
      <translation>Scan importieren</translation>
    </message>
    <message>
      <source>In which unit is the scan?</source>
      <translation>In welcher Einheit ist der Scan?</translation>
    </message>
    <message>
      <source>Inextensible sheet</source>
      <translation>Dehnungsfreies Blech</translation>
    </message>
    <message>
      <source>KUKA program (*.src)</source>
      <translation>KUKA-Programm (*.src)</translation>
    </message>
    <message>
      <source>Load the example</source>
      <translation>Beispiel laden</translation>
    </message>
    <message>
      <source>May stretch</source>
      <translation>Darf sich dehnen</translation>
    </message>
    <message>
      <source>Mean distance of the points</source>
      <translation>Mittlerer Abstand der Punkte</translation>
    </message>
    <message>
      <source>Measuring the deviation</source>
      <translation>Die Abweichung wird gemessen</translation>
    </message>
    <message>
      <source>Measuring the seams</source>
      <translation>Die Nähte werden gemessen</translation>
    </message>
    <message>
      <source>Method</source>
      <translation>Verfahren</translation>
    </message>
    <message>
      <source>More</source>
      <translation>Mehr</translation>
    </message>
    <message>
      <source>No edge is selected, so the joints are found by themselves.
Parts touch where they are nearer to each other than (mm):</source>
      <translation>Keine Kante ist gewählt, daher werden die Stöße von selbst gefunden.
Teile berühren sich, wo sie einander näher sind als (mm):</translation>
    </message>
    <message>
      <source>Noise</source>
      <translation>Rauschen</translation>
    </message>
    <message>
      <source>Nominal</source>
      <translation>Soll</translation>
    </message>
    <message>
      <source>Or leave out the fine alignment.</source>
      <translation>Oder lassen Sie die Feinausrichtung weg.</translation>
    </message>
    <message>
      <source>Outliers beyond</source>
      <translation>Ausreißer ab</translation>
    </message>
    <message>
      <source>Part</source>
      <translation>Teil</translation>
    </message>
    <message>
      <source>Pick</source>
      <translation>Wählen</translation>
    </message>
    <message>
      <source>Pick faces of the part in the 3D view.</source>
      <translation>Wählen Sie Flächen des Teils in der 3D-Ansicht.</translation>
    </message>
    <message>
      <source>Pick in the 3D view, not in the tree.</source>
      <translation>Wählen Sie in der 3D-Ansicht, nicht im Baum.</translation>
    </message>
    <message>
      <source>Pick on {scan} or on {part}.</source>
      <translation>Wählen Sie auf {scan} oder auf {part}.</translation>
    </message>
    <message>
      <source>Pick the faces to deform in the 3D view; hold Ctrl for more than one.</source>
      <translation>Wählen Sie die zu verformenden Flächen in der 3D-Ansicht; mit Strg mehrere.</translation>
    </message>
    <message>
      <source>Pick the part in the 3D view.</source>
      <translation>Wählen Sie das Teil in der 3D-Ansicht.</translation>
    </message>
    <message>
      <source>Pick the {colour} point on &lt;b&gt;{name}&lt;/b&gt;.</source>
      <translation>Wählen Sie den Punkt {colour} auf &lt;b&gt;{name}&lt;/b&gt;.</translation>
    </message>
    <message>
      <source>Pick three points on the scan and three on the part first.</source>
      <translation>Wählen Sie zuerst drei Punkte auf dem Scan und drei auf dem Teil.</translation>
    </message>
    <message>
      <source>Picture of the report (*.png)</source>
      <translation>Bild des Berichts (*.png)</translation>
    </message>
    <message>
      <source>Point at the part to read the deviation there.</source>
      <translation>Zeigen Sie auf das Teil, um die Abweichung dort zu lesen.</translation>
    </message>
    <message>
      <source>Range ±</source>
      <translation>Bereich ±</translation>
    </message>
    <message>
      <source>Re-point references</source>
      <translation>Verweise umhängen</translation>
    </message>
    <message>
      <source>Reading the scan</source>
      <translation>Der Scan wird gelesen</translation>
    </message>
    <message>
      <source>Refining the preview</source>
      <translation>Die Vorschau wird verfeinert</translation>
    </message>
    <message>
      <source>Replace</source>
      <translation>Ersetzen</translation>
    </message>
    <message>
      <source>Replace in place</source>
      <translation>An Ort und Stelle ersetzen</translation>
    </message>
    <message>
      <source>Replace scan</source>
      <translation>Scan ersetzen</translation>
    </message>
    <message>
      <source>Replace the points of {scan}, so that what was made from it follows, or add another scan?</source>
      <translation>Die Punkte von {scan} ersetzen, sodass daraus Entstandenes folgt, oder einen weiteren Scan hinzufügen?</translation>
    </message>
    <message>
      <source>Replacing is for plain shapes without a history</source>
      <translation>Ersetzen lassen sich einfache Formen ohne Historie</translation>
    </message>
    <message>
      <source>Report (*.json)</source>
      <translation>Bericht (*.json)</translation>
    </message>
    <message>
      <source>Result</source>
      <translation>Ergebnis</translation>
    </message>
    <message>
      <source>Robust: noise, gaps and clutter</source>
      <translation>Robust: Rauschen, Lücken und Fremdes</translation>
    </message>
    <message>
      <source>Scan</source>
      <translation>Scan</translation>
    </message>
    <message>
      <source>Scan points farther than this from the deformed faces are left out; automatic: a distance that suits most scans</source>
      <translation>Scanpunkte, die weiter als dies von den verformten Flächen entfernt sind, bleiben weg; automatisch: ein Abstand, der den meisten Scans entspricht</translation>
    </message>
    <message>
      <source>Scans</source>
      <translation>Scans</translation>
    </message>
    <message>
      <source>Seams</source>
      <translation>Nähte</translation>
    </message>
    <message>
      <source>Seed</source>
      <translation>Startwert</translation>
    </message>
    <message>
      <source>Sensor sees</source>
      <translation>Sensor sieht</translation>
    </message>
    <message>
      <source>Sheet</source>
      <translation>Blech</translation>
    </message>
    <message>
      <source>Simulate a scan</source>
      <translation>Scan simulieren</translation>
    </message>
    <message>
      <source>Source points</source>
      <translation>Quellpunkte</translation>
    </message>
    <message>
      <source>Spacing</source>
      <translation>Punktabstand</translation>
    </message>
    <message>
      <source>Standard deviation along the line of sight</source>
      <translation>Standardabweichung entlang der Sichtlinie</translation>
    </message>
    <message>
      <source>State</source>
      <translation>Zustand</translation>
    </message>
    <message>
      <source>Stiffness</source>
      <translation>Steifigkeit</translation>
    </message>
    <message>
      <source>Table of stations (*.csv)</source>
      <translation>Tabelle der Stationen (*.csv)</translation>
    </message>
    <message>
      <source>Take back the last point</source>
      <translation>Letzten Punkt zurücknehmen</translation>
    </message>
    <message>
      <source>The alignment is not sure: {reason}. Look at the scan, or undo and align it by three points.</source>
      <translation>Die Ausrichtung ist nicht sicher: {reason}. Sehen Sie sich den Scan an, oder machen Sie sie rückgängig und richten Sie ihn an drei Punkten aus.</translation>
    </message>
    <message>
      <source>The colour scale ends here, on both sides</source>
      <translation>Die Farbskala endet hier, auf beiden Seiten</translation>
    </message>
    <message>
      <source>The document holds no scan: import one first.</source>
      <translation>Das Dokument enthält keinen Scan: Importieren Sie zuerst einen.</translation>
    </message>
    <message>
      <source>The number of control points is chosen from the data</source>
      <translation>Die Zahl der Kontrollpunkte wird aus den Daten gewählt</translation>
    </message>
    <message>
      <source>The part is {size} mm across.</source>
      <translation>Das Teil misst {size} mm.</translation>
    </message>
    <message>
      <source>The same seed gives the same scan</source>
      <translation>Derselbe Startwert gibt denselben Scan</translation>
    </message>
    <message>
      <source>The scan does not lie on {name}: check its unit and its alignment, or choose another face.</source>
      <translation>Der Scan liegt nicht auf {name}: Prüfen Sie Einheit und Ausrichtung, oder wählen Sie eine andere Fläche.</translation>
    </message>
    <message>
      <source>The scan; picking a point cloud in the view or the tree chooses it as well</source>
      <translation>Der Scan; eine Punktwolke in der Ansicht oder im Baum zu wählen bestimmt ihn ebenfalls</translation>
    </message>
    <message>
      <source>The side seen now</source>
      <translation>Die jetzt sichtbare Seite</translation>
    </message>
    <message>
      <source>This part is shown through the link {link}: pick it where it stands itself, or make a simple copy of the link.</source>
      <translation>Dieses Teil wird durch den Link {link} gezeigt: Wählen Sie es, wo es selbst steht, oder machen Sie eine einfache Kopie des Links.</translation>
    </message>
    <message>
      <source>To the left the faces follow the scan more closely, to the right they stay smoother</source>
      <translation>Nach links folgen die Flächen dem Scan enger, nach rechts bleiben sie glatter</translation>
    </message>
    <message>
      <source>Tolerance ±</source>
      <translation>Toleranz ±</translation>
    </message>
    <message>
      <source>Unit of the scan</source>
      <translation>Einheit des Scans</translation>
    </message>
    <message>
      <source>Universal Robots program (*.script)</source>
      <translation>Universal-Robots-Programm (*.script)</translation>
    </message>
    <message>
      <source>What carries the colours</source>
      <translation>Was die Farben trägt</translation>
    </message>
    <message>
      <source>Where the sensor stands</source>
      <translation>Wo der Sensor steht</translation>
    </message>
    <message>
      <source>While this is pressed, picked faces are frozen, or set free again</source>
      <translation>Solange dies gedrückt ist, werden gewählte Flächen festgehalten oder wieder freigegeben</translation>
    </message>
    <message>
      <source>Whole part</source>
      <translation>Ganzes Teil</translation>
    </message>
    <message>
      <source>after</source>
      <translation>nachher</translation>
    </message>
    <message>
      <source>automatic</source>
      <translation>automatisch</translation>
    </message>
    <message>
      <source>before</source>
      <translation>vorher</translation>
    </message>
    <message>
      <source>beyond a limit</source>
      <translation>über einer Grenze</translation>
    </message>
    <message>
      <source>blue</source>
      <translation>blau</translation>
    </message>
    <message>
      <source>in {direction}</source>
      <translation>in {direction}</translation>
    </message>
    <message>
      <source>mean</source>
      <translation>Mittel</translation>
    </message>
    <message>
      <source>no data</source>
      <translation>keine Daten</translation>
    </message>
    <message>
      <source>nothing to compare</source>
      <translation>nichts zu vergleichen</translation>
    </message>
    <message>
      <source>pick faces in the 3D view</source>
      <translation>Flächen in der 3D-Ansicht wählen</translation>
    </message>
    <message>
      <source>red</source>
      <translation>rot</translation>
    </message>
    <message>
      <source>the part</source>
      <translation>dem Teil</translation>
    </message>
    <message>
      <source>the scan</source>
      <translation>dem Scan</translation>
    </message>
    <message>
      <source>within all limits</source>
      <translation>in allen Grenzen</translation>
    </message>
    <message>
      <source>yellow</source>
      <translation>gelb</translation>
    </message>
    <message>
      <source>{count} points: mean {mean} mm, 95 % below {p95} mm, largest {max} mm, signed mean {signed} mm</source>
      <translation>{count} Punkte: Mittel {mean} mm, 95 % unter {p95} mm, größte {max} mm, Mittel mit Vorzeichen {signed} mm</translation>
    </message>
    <message>
      <source>{names} cannot be computed on {part} and still refer to {source}.</source>
      <translation>{names} lassen sich an {part} nicht berechnen und verweisen weiter auf {source}.</translation>
    </message>
    <message>
      <source>{name} is neither a face nor a point cloud: pick faces of a part, and a scan.</source>
      <translation>{name} ist weder eine Fläche noch eine Punktwolke: Wählen Sie Flächen eines Teils und einen Scan.</translation>
    </message>
    <message>
      <source>{name} is to be deformed and to be frozen: choose one.</source>
      <translation>{name} soll verformt und festgehalten werden: Wählen Sie eines.</translation>
    </message>
    <message>
      <source>{part} is made from {source}: pick faces of one of these two.</source>
      <translation>{part} entsteht aus {source}: Wählen Sie Flächen eines dieser beiden.</translation>
    </message>
    <message>
      <source>{scan}: {on_scan} of {all}, {part}: {on_part} of {all} points. Pair by pair in the same order: {colours}.</source>
      <translation>{scan}: {on_scan} von {all}, {part}: {on_part} von {all} Punkten. Paar für Paar in derselben Reihenfolge: {colours}.</translation>
    </message>
    <message>
      <source>{share} % within the tolerance</source>
      <translation>{share} % in der Toleranz</translation>
    </message>
    <message>
      <source>{unit}: it is {size} mm across</source>
      <translation>{unit}: er misst {size} mm</translation>
    </message>
  </context>
  <context>
    <name>FFDS_AddTrajectory</name>
    <message>
      <source>Add robot trajectory</source>
      <translation>Roboterbahn hinzufügen</translation>
    </message>
    <message>
      <source>Add the selected seams to the document as trajectories for FreeCAD's Robot workbench</source>
      <translation>Die gewählten Nähte als Bahnen für FreeCADs Robot-Arbeitsbereich ins Dokument einfügen</translation>
    </message>
    <message>
      <source>Adds the selected seams to the document as trajectories for the Robot workbench.</source>
      <translation>Fügt die gewählten Nähte als Bahnen für den Robot-Arbeitsbereich ins Dokument ein.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_AlignByPoints</name>
    <message>
      <source>Align scan by three points…</source>
      <translation>Scan an drei Punkten ausrichten …</translation>
    </message>
    <message>
      <source>Pick three points on the scan and the same three on the part; the alignment goes on from there</source>
      <translation>Drei Punkte auf dem Scan und dieselben auf dem Teil wählen; die Ausrichtung macht von dort weiter</translation>
    </message>
    <message>
      <source>Where a scan is not aligned by itself: pick three points on the scan and the same three, in the same order, on the part.</source>
      <translation>Wo ein Scan nicht von selbst ausgerichtet wird: Wählen Sie drei Punkte auf dem Scan und dieselben drei, in derselben Reihenfolge, auf dem Teil.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_AlignScan</name>
    <message>
      <source>Align scan with part</source>
      <translation>Scan am Teil ausrichten</translation>
    </message>
    <message>
      <source>Finds the rigid motion that brings the scan onto the part, from wherever it lies, and says how sure that is. Select the part and the scan.</source>
      <translation>Findet die starre Bewegung, die den Scan auf das Teil bringt, wo immer er liegt, und sagt, wie sicher das ist. Wählen Sie Teil und Scan.</translation>
    </message>
    <message>
      <source>Move the selected scan onto the selected part, from wherever it lies</source>
      <translation>Den gewählten Scan auf das gewählte Teil bewegen, wo immer er liegt</translation>
    </message>
  </context>
  <context>
    <name>FFDS_DeformFaces</name>
    <message>
      <source>Deform faces to scan…</source>
      <translation>Flächen an Scan anpassen …</translation>
    </message>
    <message>
      <source>Deform the selected faces to a scan, with a live preview; the faces around them adapt</source>
      <translation>Die gewählten Flächen mit Vorschau an einen Scan anpassen; die Flächen ringsum folgen</translation>
    </message>
    <message>
      <source>Select faces of a part and a scan, in any order, before or after opening the panel. The preview follows the settings. OK adds an as-built part that follows the nominal part and the scan; its topology is that of the nominal part.</source>
      <translation>Wählen Sie Flächen eines Teils und einen Scan, in beliebiger Reihenfolge, vor oder nach dem Öffnen. Die Vorschau folgt den Einstellungen. OK fügt ein Ist-Teil hinzu, das Sollteil und Scan folgt; seine Topologie ist die des Sollteils.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_DeformWorkpiece</name>
    <message>
      <source>All faces of the part are fitted to the scan together. Faces that the scan does not see are carried along by those that it sees; frozen faces stay. OK adds an as-built part.</source>
      <translation>Alle Flächen des Teils werden gemeinsam an den Scan angepasst. Flächen, die der Scan nicht sieht, gehen mit denen mit, die er sieht; festgehaltene bleiben. OK fügt ein Ist-Teil hinzu.</translation>
    </message>
    <message>
      <source>Deform all faces of a part to a scan together; faces that the scan does not see are carried along</source>
      <translation>Alle Flächen eines Teils gemeinsam an einen Scan anpassen; die der Scan nicht sieht, gehen mit</translation>
    </message>
    <message>
      <source>Deform whole part to scan…</source>
      <translation>Ganzes Teil an Scan anpassen …</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ExportAsBuilt</name>
    <message>
      <source>Export as-built part…</source>
      <translation>Ist-Teil exportieren …</translation>
    </message>
    <message>
      <source>Write the selected part as STEP, BREP or FCStd, with its name and face colours</source>
      <translation>Das gewählte Teil als STEP, BREP oder FCStd schreiben, mit Namen und Flächenfarben</translation>
    </message>
    <message>
      <source>Writes the selected part with its name and its face colours. The file is written whole or not at all.</source>
      <translation>Schreibt das gewählte Teil mit seinem Namen und seinen Flächenfarben. Die Datei entsteht ganz oder gar nicht.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ExportProgram</name>
    <message>
      <source>Export robot program…</source>
      <translation>Roboterprogramm exportieren …</translation>
    </message>
    <message>
      <source>Write the selected seams for KUKA, ABB or Universal Robots, or as a table, a report or a picture</source>
      <translation>Die gewählten Nähte für KUKA, ABB oder Universal Robots schreiben, oder als Tabelle, Bericht oder Bild</translation>
    </message>
    <message>
      <source>Writes the selected seams for KUKA, ABB or Universal Robots, as a table, as a report or as a picture.</source>
      <translation>Schreibt die gewählten Nähte für KUKA, ABB oder Universal Robots, als Tabelle, als Bericht oder als Bild.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_FindSeams</name>
    <message>
      <source>Find weld seams…</source>
      <translation>Schweißnähte finden …</translation>
    </message>
    <message>
      <source>Follows the selected edges, or finds the joints between the parts of the selected object. The seams follow the part; limits, torch angles, tool and base are in their properties.</source>
      <translation>Folgt den gewählten Kanten oder findet die Stöße zwischen den Teilen des gewählten Objekts. Die Nähte folgen dem Teil; Grenzen, Brennerwinkel, Werkzeug und Basis stehen in ihren Eigenschaften.</translation>
    </message>
    <message>
      <source>Weld seams along the selected edges, or wherever the parts of the selected object lie on each other</source>
      <translation>Schweißnähte entlang der gewählten Kanten oder überall, wo die Teile des gewählten Objekts aufeinanderliegen</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ImportScan</name>
    <message>
      <source>Import a scan as a point cloud: PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 or STL; several files are fused</source>
      <translation>Einen Scan als Punktwolke importieren: PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 oder STL; mehrere Dateien werden vereinigt</translation>
    </message>
    <message>
      <source>Import scan…</source>
      <translation>Scan importieren …</translation>
    </message>
    <message>
      <source>Reads PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 and STL files into a point cloud. Several files of one part become one scan. Where the size of the scan does not suit the part, the unit is asked for. With a scan selected, its points can be replaced, and what was made from it follows.</source>
      <translation>Liest PLY-, PCD-, XYZ-, ASC-, TXT-, CSV-, PTS-, E57- und STL-Dateien in eine Punktwolke. Mehrere Dateien eines Teils werden ein Scan. Passt die Größe des Scans nicht zum Teil, wird nach der Einheit gefragt. Ist ein Scan gewählt, können seine Punkte ersetzt werden, und was daraus entstand, folgt.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_LoadExample</name>
    <message>
      <source>Load the example</source>
      <translation>Beispiel laden</translation>
    </message>
    <message>
      <source>Open a sheet-metal bracket and a scan of it as it came out, to try everything on</source>
      <translation>Einen Blechwinkel und seinen Scan öffnen, um alles auszuprobieren</translation>
    </message>
    <message>
      <source>Opens a sheet-metal bracket and a scan of it as it came out of the press, to try everything on.</source>
      <translation>Öffnet einen Blechwinkel und einen Scan davon, wie er aus der Presse kam, um alles auszuprobieren.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_RepointReferences</name>
    <message>
      <source>Let what refers to the nominal part, or to its faces and edges, refer to the selected as-built part</source>
      <translation>Was auf das Sollteil oder seine Flächen und Kanten verweist, auf das gewählte Ist-Teil verweisen lassen</translation>
    </message>
    <message>
      <source>Re-point references</source>
      <translation>Verweise umhängen</translation>
    </message>
    <message>
      <source>Sketches on a face, fillets, cuts, drawings, seams: what refers to the nominal part or to its faces, edges and vertices refers to the same ones of the selected as-built part from now on. What cannot be computed on it is left as it was.</source>
      <translation>Skizzen auf einer Fläche, Verrundungen, Schnitte, Zeichnungen, Nähte: Was auf das Sollteil oder seine Flächen, Kanten und Ecken verweist, verweist fortan auf dieselben des gewählten Ist-Teils. Was sich daran nicht berechnen lässt, bleibt, wie es war.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ShowDeviation</name>
    <message>
      <source>Colour the scan or the part by its deviation, before and after, with a legend and a histogram</source>
      <translation>Scan oder Teil nach der Abweichung einfärben, vorher und nachher, mit Legende und Histogramm</translation>
    </message>
    <message>
      <source>Colours the scan or the part by the distance between them, nominal and as built. The panel has the range, the tolerance, the histogram and the value under the cursor.</source>
      <translation>Färbt Scan oder Teil nach ihrem Abstand ein, Soll und Ist. Bereich, Toleranz, Histogramm und der Wert unter dem Mauszeiger stehen in der Aufgabe.</translation>
    </message>
    <message>
      <source>Show deviation</source>
      <translation>Abweichung zeigen</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ShowLattice</name>
    <message>
      <source>Draw the control lattices of the selected as-built part, before and after, or hide them</source>
      <translation>Die Kontrollgitter des gewählten Ist-Teils zeichnen, vorher und nachher, oder verbergen</translation>
    </message>
    <message>
      <source>Draws the control lattice of every deformed face of the selected as-built part, before (grey) and after (orange).</source>
      <translation>Zeichnet das Kontrollgitter jeder verformten Fläche des gewählten Ist-Teils, vorher (grau) und nachher (orange).</translation>
    </message>
    <message>
      <source>Show control lattice</source>
      <translation>Kontrollgitter zeigen</translation>
    </message>
  </context>
  <context>
    <name>FFDS_SimulateScan</name>
    <message>
      <source>Scan the selected part with a virtual sensor: from the side that is seen now, or from all around</source>
      <translation>Das gewählte Teil mit einem virtuellen Sensor scannen: von der jetzt sichtbaren Seite oder von allen Seiten</translation>
    </message>
    <message>
      <source>Scans the selected part with a virtual sensor: points with noise of the side that is seen now, or of all sides.</source>
      <translation>Scannt das gewählte Teil mit einem virtuellen Sensor: verrauschte Punkte der jetzt sichtbaren Seite oder aller Seiten.</translation>
    </message>
    <message>
      <source>Simulate a scan…</source>
      <translation>Scan simulieren …</translation>
    </message>
  </context>
  <context>
    <name>FfdsPreferences</name>
    <message>
      <source>1 suits most scans; above, the faces stay smoother, below, they follow the scan more closely</source>
      <translation>1 passt für die meisten Scans; darüber bleiben die Flächen glatter, darunter folgen sie dem Scan enger</translation>
    </message>
    <message>
      <source>3D view</source>
      <translation>3D-Ansicht</translation>
    </message>
    <message>
      <source>Decide from the scan</source>
      <translation>Aus dem Scan entscheiden</translation>
    </message>
    <message>
      <source>Deviations up to this are shown in one green; 0: none</source>
      <translation>Abweichungen bis hierhin erscheinen in einem Grün; 0: keine</translation>
    </message>
    <message>
      <source>Draw the control lattices in this preview</source>
      <translation>In dieser Vorschau die Kontrollgitter zeichnen</translation>
    </message>
    <message>
      <source>FFD by Hsu: a lattice in space</source>
      <translation>FFD nach Hsu: ein Gitter im Raum</translation>
    </message>
    <message>
      <source>FFDS as published</source>
      <translation>FFDS wie veröffentlicht</translation>
    </message>
    <message>
      <source>For whole sheet parts</source>
      <translation>Für ganze Blechteile</translation>
    </message>
    <message>
      <source>General</source>
      <translation>Allgemein</translation>
    </message>
    <message>
      <source>How the control points are found</source>
      <translation>Wie die Kontrollpunkte gefunden werden</translation>
    </message>
    <message>
      <source>Inextensible sheet</source>
      <translation>Dehnungsfreies Blech</translation>
    </message>
    <message>
      <source>May stretch</source>
      <translation>Darf sich dehnen</translation>
    </message>
    <message>
      <source>Method</source>
      <translation>Verfahren</translation>
    </message>
    <message>
      <source>New as-built parts</source>
      <translation>Neue Ist-Teile</translation>
    </message>
    <message>
      <source>Outliers beyond</source>
      <translation>Ausreißer ab</translation>
    </message>
    <message>
      <source>Robust: noise, gaps and clutter</source>
      <translation>Robust: Rauschen, Lücken und Fremdes</translation>
    </message>
    <message>
      <source>Scan points farther than this from the deformed faces are left out</source>
      <translation>Scanpunkte, die weiter als dies von den verformten Flächen entfernt sind, bleiben weg</translation>
    </message>
    <message>
      <source>Sheet</source>
      <translation>Blech</translation>
    </message>
    <message>
      <source>Show the deformed faces while settings change</source>
      <translation>Verformte Flächen zeigen, während sich Einstellungen ändern</translation>
    </message>
    <message>
      <source>Stiffness</source>
      <translation>Steifigkeit</translation>
    </message>
    <message>
      <source>Tolerance of the deviation map</source>
      <translation>Toleranz der Abweichungskarte</translation>
    </message>
    <message>
      <source>automatic</source>
      <translation>automatisch</translation>
    </message>
  </context>
  <context>
    <name>Workbench</name>
    <message>
      <source>Deform a CAD model to a scan; its topology stays</source>
      <translation>Ein CAD-Modell an einen Scan anpassen; seine Topologie bleibt</translation>
    </message>
  </context>
</TS>
